import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from learning.logs import desks, row

from qsrlang.errors import FileError, ValueRangeError
from qsrlang.learning.formats.ithor import read_ithor_table
from qsrlang.learning.formats.kth import read_kth_table, read_kth_xml
from qsrlang.learning.formats.tables import arrow_parquet, csv_text, json_lines_text, write_observations
from qsrlang.learning.observations import NUMBERS, TEXTS, Observations, joined
from qsrlang.learning.reading import read_observations
from qsrlang.learning.screening import Unsound, screened, sound

GOOD = {"scene": "s", "object": "m", "kind": "Mug", "x": "0.5", "y": "1"}
KTH = "desk,scene,date,part,desk_length,desk_width,object,class,x,y,z,yaw,length,width,height\n"
ITHOR = (
    "group,scene,object_type,object_id,pos_x,pos_y,pos_z,yaw_deg,aabb_cx,aabb_cy,aabb_cz,aabb_sx,aabb_sy,aabb_sz,"
    "parent_receptacles,pickupable,moveable\n"
)


def equal(one, other):
    same = all(one.text(name) == other.text(name) for name in TEXTS)
    return same and np.array_equal(one.numbers, other.numbers, equal_nan=True)


def test_rows_come_back_as_they_were():
    seen = desks(2, 2, np.random.default_rng(0))
    assert equal(seen, Observations.of(seen.rows()))
    assert len(seen) == 16
    assert set(seen.text("kind")) == {"Desk", "Keyboard", "Mouse", "Mug"}


def test_batches_cut_no_scene_and_lose_no_row():
    seen = desks(5, 7, np.random.default_rng(1))
    parts = list(seen.batches(11))
    assert len(parts) > 3
    assert equal(joined(parts), seen)
    scenes = [set(part.text("scene")) for part in parts]
    assert sum(len(one) for one in scenes) == len(set(seen.text("scene")))


def test_among_keeps_or_leaves_out():
    seen = desks(3, 2, np.random.default_rng(2))
    own, others = seen.among("place", ["room-1"]), seen.among("place", ["room-1"], keep=False)
    assert set(own.text("place")) == {"room-1"}
    assert len(own) + len(others) == len(seen)


def test_columns_of_different_lengths_are_refused():
    with pytest.raises(ValueRangeError, match="shape of the numbers"):
        Observations(np.zeros((2, len(TEXTS)), dtype=int), np.zeros((1, len(NUMBERS))), ("",))


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"x": "1e36"}, "further away than 1000 m"),
        ({"y": "nan"}, "with a y that is not finite"),
        ({"x": "left"}, "with a x that is no number"),
        ({"yaw": "1e9"}, "with a bad yaw"),
        ({"yaw": "inf"}, "with a bad yaw"),
        ({"width": "-0.1"}, "with a size below 0 or above 20 m"),
        ({"confidence": "1.5"}, "with a confidence outside 0 to 1"),
        ({"time": "noon"}, "with a time that is neither ISO 8601 nor seconds"),
        ({"kind": ""}, "without kind"),
    ],
)
def test_what_cannot_be_used_is_set_aside_with_its_reason(change, reason):
    reading = screened([("log.csv:2", GOOD), ("log.csv:3", GOOD | change)])
    assert len(reading.observations) == 1
    assert dict(reading.reasons) == {reason: 1}
    assert reading.aside[0].where == "log.csv:3"
    assert reason in reading.report()


def test_gaps_are_filled_as_the_schema_says():
    row = sound(GOOD)
    assert math.isnan(row["yaw"])
    assert (row["confidence"], row["z"], row["support"]) == (1.0, 0.0, "")


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("Mug", "Mug"),
        ("coffee mug", "coffee-mug"),
        ("133", "place-133"),
        ("Tisch-Größe", "Tisch-Größe"),
        ("a. b", "a-b"),
    ],
)
def test_places_and_classes_are_names_of_the_language(text, name):
    assert sound(GOOD | {"place": text})["place"] == name


def test_times_are_iso_8601_or_seconds():
    assert sound(GOOD | {"time": "1970-01-02T06:00:00"})["time"] == 86400.0 + 6 * 3600.0
    assert sound(GOOD | {"time": "12.5"})["time"] == 12.5


@given(st.dictionaries(st.sampled_from(["x", "y", "yaw", "time", "width", "kind"]), st.text() | st.floats()))
def test_no_row_breaks_the_screening(change):
    try:
        numbers = sound(GOOD | change)
    except Unsound:
        return
    assert all(math.isfinite(numbers[name]) for name in NUMBERS if name != "yaw")


@pytest.mark.parametrize("ending", ["csv", "jsonl", "parquet"])
def test_what_is_written_is_read_again(ending, tmp_path):
    if ending == "parquet" and arrow_parquet is None:
        pytest.skip("pyarrow is not installed: pip install 'qsrlang[parquet]'")
    seen = Observations.of([row("Mug", 0.25, -0.5, yaw=math.nan), row("Keyboard", 1.0, 2.0, time=7.5)])
    path = tmp_path / f"log.{ending}"
    write_observations(seen, path)
    assert equal(read_observations(path).observations, seen)


def test_damaged_lines_are_counted(tmp_path):
    seen = Observations.of([row("Mug", 0.25, -0.5)])
    path = tmp_path / "log.jsonl"
    path.write_text(json_lines_text(seen) + "{\n[1]\n" + "[" * 20_000 + "\n")
    reading = read_observations(path)
    assert (len(reading.observations), reading.rejected) == (1, 3)
    table = tmp_path / "log.csv"
    table.write_text(csv_text(seen) + "1,2,3\n")
    assert dict(read_observations(table).reasons) == {"with too few or too many cells": 1}


def test_rows_set_aside_can_be_kept(tmp_path):
    reading = screened([("log.csv:3", GOOD | {"x": "1e36"})])
    reading.write_aside(tmp_path / "aside.jsonl")
    assert '"reason": "further away than 1000 m"' in (tmp_path / "aside.jsonl").read_text()


@pytest.mark.parametrize("name", ["log.txt", "none.csv", "bare.csv", "log.parquet", "log.xml"])
def test_files_of_no_known_format_are_refused(name, tmp_path):
    path = tmp_path / name
    if name != "none.csv":
        path.write_text("a,b\n1,2\n")
    with pytest.raises(FileError, match=name):
        read_observations(path)


def test_kth_axes_become_away_and_left(tmp_path):
    path = tmp_path / "desks.csv"
    path.write_text(KTH + "d,s,131023,Aft,1.6,0.8,Mouse,Mouse,1.0,0.3,0,0.1,0.05,0.1,0.03\n")
    mouse = next(one for one in read_observations(path).observations.rows() if one["kind"] == "Mouse")
    assert (mouse["x"], mouse["y"]) == (0.3, -1.0)
    assert mouse["yaw"] == pytest.approx(np.pi + 0.1)
    assert (mouse["length"], mouse["width"], mouse["support"]) == (0.1, 0.05, "Desk")
    desk = next(one for one in read_observations(path).observations.rows() if one["kind"] == "Desk")
    assert (desk["x"], desk["y"], desk["length"], desk["width"]) == (0.4, -0.8, 0.8, 1.6)
    assert [where for where, _ in read_kth_table(path)] == ["desks.csv:2", "desks.csv:2"]


def test_kth_annotations_are_read_and_entities_refused(tmp_path):
    body = """<scenario><dimensions><length>1.2</length><width>0.7</width></dimensions><allObjects><object>
    <name>Mug_1</name><pose><x>0.3</x><y>0.1</y><z>0</z><yaw>0.2</yaw></pose>
    <dimensions><length>0.1</length><width>0.1</width><height>1e36</height></dimensions></object></allObjects></scenario>"""
    path = tmp_path / "desk.xml"
    path.write_text(body)
    reading = read_observations(path)
    assert reading.observations.text("kind") == ["Desk"]
    assert dict(reading.reasons) == {"with a size below 0 or above 20 m": 1}
    path.write_text(body.replace("1e36", "0.1"))
    assert read_observations(path).observations.text("kind") == ["Desk", "Mug"]
    path.write_text('<!DOCTYPE a [<!ENTITY b "c">]>' + body)
    with pytest.raises(FileError, match="entities"):
        list(read_kth_xml(path))


def test_unitys_left_handed_frame_is_turned(tmp_path):
    """A sink at (x 1, z 2) whose front, +z turned 90 deg clockwise, looks along Unity's +x: to the right, our -y."""
    path = tmp_path / "rooms.csv"
    row = "kitchens,R1,Sink,Sink|1,1,0.9,2,90,1,0.95,2,0.5,0.1,0.7,Floor|0;CounterTop|2,0,0\n"
    path.write_text(ITHOR + row + row.replace("Sink", "Apple"))
    sink, apple = read_observations(path).observations.rows()
    assert (sink["x"], sink["y"]) == (2.0, -1.0)
    assert (np.cos(sink["yaw"]), np.sin(sink["yaw"])) == pytest.approx((0.0, -1.0))
    assert (sink["length"], sink["width"], sink["support"]) == (0.5, 0.7, "CounterTop|2")
    assert math.isnan(apple["yaw"])
    assert len(list(read_ithor_table(path))) == 2


HEADERS = ("scene,object,class,x,y\n", KTH, ITHOR, "")


@given(
    st.sampled_from(["csv", "jsonl", "xml"]),
    st.sampled_from(HEADERS),
    st.binary(max_size=200) | st.text('0123456789.,"\n<>{}ane-', max_size=200).map(str.encode),
)
def test_no_file_breaks_the_reading(tmp_path_factory, ending, header, content):
    path = tmp_path_factory.mktemp("log") / f"log.{ending}"
    path.write_bytes(header.encode() + content)
    try:
        reading = read_observations(path)
    except FileError:
        return
    assert np.isfinite(reading.observations.number("x")).all()
