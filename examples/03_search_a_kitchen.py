"""Search for a cup in the built-in kitchen-office, once by the relations and once by the supporting planes alone."""

import qsrlang as qsr

for planner in ("planes", "qsr"):
    story = qsr.search("kitchen", target="Cup", planner=planner, seed=7)
    outcome = f"found {story.detection.name}" if story.detection else "found nothing"
    print(f"{planner}: {outcome} after {story.seconds:.1f} s, {story.poses} looks, {story.travel:.1f} m")
