from itertools import product

import numpy as np
import pytest
from learning.logs import desks, row

import qsrlang as qsr
from qsrlang.errors import FileError
from qsrlang.language.diagnostics import LanguageError
from qsrlang.learning.differences import differences, divergence_bits
from qsrlang.learning.experience import experience_of
from qsrlang.learning.merging import BEGIN, END, learn_into, merged, without_learned
from qsrlang.learning.observations import Observations, joined
from qsrlang.learning.writing import Contexts
from qsrlang.mixtures.gaussian import GaussianMixture

PLAIN = Contexts()
HAND = "language 1.\n\n# Mine, with odd   blanks.\nstatic   Keyboard {size: 45cm × 15cm × 3cm}.\n"
FIRST = desks(5, 4, np.random.default_rng(1))
SECOND = desks(6, 3, np.random.default_rng(2))


def block(text):
    return text[text.index(BEGIN) : text.index(END)]


def statements(text):
    return [line for line in block(text).splitlines() if not line.startswith("# Sums")]


def test_learning_on_is_learning_from_all(tmp_path):
    two, one = tmp_path / "two.qsr", tmp_path / "one.qsr"
    learn_into(two, experience_of(FIRST), PLAIN)
    learn_into(two, experience_of(SECOND), PLAIN)
    learn_into(one, experience_of(joined([FIRST, SECOND])), PLAIN)
    assert statements(two.read_text()) == statements(one.read_text())
    assert len(list(tmp_path.glob("two.*.sums"))) == 1
    assert "right-of(Mouse, Keyboard) ~ normal(" in two.read_text()


def test_what_people_wrote_stays_byte_for_byte(tmp_path):
    path = tmp_path / "desk.qsr"
    path.write_text(HAND + "\nobserve right-of(Mug, Keyboard).\ndynamic Mug.\n")
    before = path.read_text()
    learn_into(path, experience_of(FIRST), PLAIN)
    text = path.read_text()
    assert text.startswith(before) and without_learned(text).startswith(before)
    assert "static Keyboard" not in block(text) and "dynamic Mug" not in block(text)
    path.write_text(text + "\n# Behind it.\n")
    learn_into(path, experience_of(SECOND), PLAIN)
    assert path.read_text().startswith(before) and path.read_text().endswith("\n# Behind it.\n")
    assert path.read_text().count(BEGIN) == 1


def test_a_file_that_is_wrong_is_left_alone(tmp_path):
    path = tmp_path / "desk.qsr"
    path.write_text("static Keyboard {.\n")
    with pytest.raises(LanguageError):
        learn_into(path, experience_of(FIRST), PLAIN)
    assert path.read_text() == "static Keyboard {.\n" and list(tmp_path.iterdir()) == [path]


def test_without_its_sums_a_file_cannot_learn_on(tmp_path):
    path = tmp_path / "desk.qsr"
    learn_into(path, experience_of(FIRST), PLAIN, keep_sums=False)
    assert list(tmp_path.iterdir()) == [path]
    with pytest.raises(FileError, match="without keeping its sums"):
        learn_into(path, experience_of(SECOND), PLAIN)
    other = tmp_path / "other.qsr"
    learn_into(other, experience_of(FIRST), PLAIN)
    next(tmp_path.glob("other.*.sums")).unlink()
    with pytest.raises(FileError, match="which is gone"):
        learn_into(other, experience_of(SECOND), PLAIN)


def test_rooms_are_told_apart(tmp_path):
    path = tmp_path / "desk.qsr"
    seen = desks(6, 5, np.random.default_rng(5), left=0.4)
    learn_into(path, experience_of(seen), Contexts(room=True))
    knowledge = qsr.load(path)
    told = ("Mouse", "Keyboard") if "(Mouse, Keyboard)" in path.read_text() else ("Keyboard", "Mouse")
    general = knowledge.where(told[0], wrt=told[1]).mixture.moments()[0]
    sides = []
    for number in range(6):
        here = knowledge.under(qsr.Circumstances(room=f"room-{number}"))
        sides.append(here.where(told[0], wrt=told[1]).mixture.moments()[0][1])
    assert min(sides) < -0.2 and max(sides) > 0.2
    assert min(sides) < general[1] < max(sides)


def test_rooms_and_hours_are_told_apart_together(tmp_path):
    """On every desk the mouse is right of the keyboard before noon, and left of it after."""
    rows = []
    for place, day, hour in product(range(6), range(4), range(0, 24, 2)):
        at = {
            "place": f"room-{place}",
            "scene": f"{place}-{day}-{hour}",
            "time": 86400.0 * day + 3600.0 * hour,
        }
        y = 0.3 if hour >= 12 else -0.3
        rows += [row("Desk", 0.4, 0.0, **at), row("Keyboard", 0.3, 0.0, **at), row("Mouse", 0.3, y, **at)]
    path = tmp_path / "desk.qsr"
    learn_into(path, experience_of(Observations.of(rows)), Contexts(room=True, time=True))
    knowledge = qsr.load(path)
    for room in (None, "room-3"):
        sides = [
            knowledge.under(qsr.Circumstances(room=room, minutes=60 * hour))
            .where("Mouse", wrt="Keyboard")
            .mixture.moments()[0][1]
            for hour in (9, 15)
        ]
        assert sides[0] < -0.1 and sides[1] > 0.1


def test_a_week_in_one_room_is_learned(tmp_path):
    path = tmp_path / "desk.qsr"
    learn_into(path, experience_of(desks(1, 12, np.random.default_rng(3))))
    where = qsr.load(path).where("Mouse", wrt="Keyboard").mixture
    np.testing.assert_allclose(where.means[where.weights.argmax()], (0.0, -0.3), atol=0.06)
    assert "from one sighting there to the next" in path.read_text()
    assert qsr.check(path).errors == ()


def test_a_block_takes_the_place_of_the_block_before():
    once = merged("a.", "one")
    assert merged(once, "two") == once.replace("one", "two")
    assert without_learned(once) == "a.\n\n"


def test_what_changed_is_told_in_words_and_bits(tmp_path):
    old = qsr.parse_knowledge(
        "dynamic Cup. static Plate. observe 1 × left-of(Cup, Plate) ~ normal((0 cm, 20 cm), (5 cm, 5 cm), 0)."
    )
    new = qsr.parse_knowledge(
        "dynamic Cup. static Plate. observe 1 × left-of(Cup, Plate) ~ normal((0 cm, 30 cm), (5 cm, 5 cm), 0)."
    )
    assert differences(old, old) == []
    (change,) = differences(old, new)
    assert change.pair == ("Cup", "Plate") and "mean moved 10 cm" in change.words
    assert change.bits == pytest.approx(2.0 / np.log(2.0), abs=4 * change.error)
    more = qsr.parse_knowledge("dynamic Cup, Fork. static Plate. observe left-of(Fork, Plate).")
    assert {(one.pair[0], one.words) for one in differences(old, more)} == {
        ("Cup", "is gone"),
        ("Fork", "is new"),
    }


def test_divergence_is_that_of_two_gaussians():
    one = GaussianMixture(np.ones(1), np.zeros((1, 2)), np.eye(2)[None])
    other = GaussianMixture(np.ones(1), np.array([[1.0, 0.0]]), 4.0 * np.eye(2)[None])
    bits, error = divergence_bits(one, other)
    exact = 0.5 * (0.5 + 0.25 - 2.0 + 4.0 * np.log(2.0)) / np.log(2.0)
    assert abs(bits - exact) < 4 * error + 1e-9


def test_shipped_knowledge_tells_what_was_seen():
    desk = qsr.load("office/desks")
    where = desk.where("Keyboard", landmarks={"Monitor": qsr.Pose2(0.0, 0.0, -np.pi / 2)})
    x, y = where.mixture.moments()[0]
    assert abs(x) < 0.1 and -0.4 < y < -0.15
    kitchen = qsr.load("kitchen/ithor")
    assert {"Mug", "CounterTop", "Fridge"} <= set(kitchen.classes)
