import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from learning.logs import desks, row

from qsrlang.errors import FileError
from qsrlang.learning.cells import cells_of
from qsrlang.learning.experience import experience_bytes, experience_of, read_experience
from qsrlang.learning.observations import Observations, joined
from qsrlang.learning.placements import MAX_TURN, REACH, placements_of
from qsrlang.learning.summing import CELL
from qsrlang.learning.sums import PlacementSums, added, no_sums, sums_of


def same(one, other):
    return (
        one.words == other.words
        and np.array_equal(one.keys, other.keys)
        and np.allclose(one.moments, other.moments, rtol=1e-9, atol=1e-12)
        and np.allclose(one.hours, other.hours, rtol=1e-9)
    )


def slow_placements(seen):
    """Every pair of a scene, one after the other, in plain Python."""
    rows = list(seen.rows())
    found = []
    for relatum in rows:
        scene = [one for one in rows if one["scene"] == relatum["scene"]]
        if next(one for one in scene if one["kind"] == relatum["kind"]) is not relatum:
            continue
        for referent in scene:
            if referent["kind"] == relatum["kind"] or referent["support"] not in (
                relatum["object"],
                relatum["support"],
            ):
                continue
            carrier = next((one for one in scene if one["object"] == referent["support"]), None)
            turn = 0.0 if carrier is None else np.angle(np.exp(1j * (relatum["yaw"] - carrier["yaw"])))
            heading = (
                relatum["yaw"]
                if carrier is None
                else carrier["yaw"] + (turn if abs(turn) <= MAX_TURN else 0.0)
            )
            off = complex(referent["x"] - relatum["x"], referent["y"] - relatum["y"])
            if abs(off) <= REACH:
                point = off * np.exp(-1j * (heading + np.pi))
                found.append((referent["object"], relatum["object"], point.real, point.imag))
    return found


def test_placements_are_those_of_slow_code():
    rng = np.random.default_rng(3)
    rows = []
    for scene in range(6):
        at = {"scene": str(scene)}
        rows.append(row("Desk", 0.4, 0.0, yaw=np.pi + 0.3, **at))
        for kind in ("Keyboard", "Mouse", "Mug", "Mug"):
            rows.append(row(kind, *rng.uniform(-2.0, 2.0, 2), yaw=rng.uniform(-4.0, 4.0), **at))
    seen = Observations.of(rows)
    placed = placements_of(seen)
    names = np.array(seen.text("object"))
    fast = sorted(zip(names[placed.referents], names[placed.relata], *placed.points.T, strict=True))
    slow = sorted(slow_placements(seen))
    assert [one[:2] for one in fast] == [one[:2] for one in slow]
    np.testing.assert_allclose([one[2:] for one in fast], [one[2:] for one in slow], atol=1e-12)


def test_sums_are_those_of_the_placements():
    seen = desks(4, 5, np.random.default_rng(4))
    placed = placements_of(seen)
    kinds, places = np.array(seen.text("kind")), np.array(seen.text("place"))
    own = (kinds[placed.referents] == "Mouse") & (kinds[placed.relata] == "Keyboard")
    points = placed.points[own & (places[placed.referents] == "room-2")]
    sums = sums_of(seen).of_pair("Mouse", "Keyboard").at(["room-2"])
    assert sums.counts.sum() == len(points) == 5
    middle = sums.moments[:, :2] + CELL * sums.keys[:, 3:] * sums.counts[:, None]
    np.testing.assert_allclose(middle.sum(axis=0), points.sum(axis=0))
    cells = cells_of(sums_of(seen).of_pair("Mouse", "Keyboard"))
    assert cells.shares.sum() == pytest.approx(4.0)
    np.testing.assert_allclose(cells.hours.sum(axis=1), cells.shares)


@given(st.integers(0, 2**32 - 1), st.integers(1, 40), st.permutations(range(6)))
def test_online_batch_and_any_order_are_the_same(seed, size, order):
    parts = [desks(2, 2, np.random.default_rng([seed, number])) for number in range(6)]
    whole = PlacementSums.of(joined(parts)) + no_sums()
    online = no_sums()
    for number in order:
        for batch in parts[number].batches(size):
            online = online + PlacementSums.of(batch)
    assert same(online, whole)
    assert same(added([sums_of(part) for part in parts]), whole)


def test_what_is_kept_does_not_grow_with_how_often_it_was_seen():
    seen = desks(2, 5, np.random.default_rng(0))
    once, often = sums_of(seen), sums_of(joined([seen] * 50))
    assert len(once) == len(often)
    np.testing.assert_allclose(often.counts, 50 * once.counts)


def test_confidence_weighs():
    rows = [row("Desk", 0.4, 0.0), row("Keyboard", 0.3, 0.0), row("Mug", 0.4, 0.2, confidence=0.25)]
    assert sums_of(Observations.of(rows)).of_pair("Mug", "Keyboard").counts == pytest.approx([0.25])


def test_an_experience_is_kept_in_a_file(tmp_path):
    known = experience_of(desks(3, 3, np.random.default_rng(5)))
    path = tmp_path / "desk.sums"
    path.write_bytes(experience_bytes(known))
    again = read_experience(path)
    assert same(again.placements, known.placements)
    assert again.sources == known.sources == {"log": 36}
    np.testing.assert_allclose(again.objects.size("Keyboard"), (0.16, 0.45, 0.04))
    path.write_bytes(b"PK\x03\x04 no sums")
    with pytest.raises(FileError, match="holds no sums"):
        read_experience(path)
