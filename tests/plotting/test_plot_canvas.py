import subprocess
import sys
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest

from qsrlang.errors import FileError, ValueRangeError
from qsrlang.plotting.canvas import Ground, new_figure, plane_figure, save_figure
from qsrlang.plotting.style import length_text, round_length

MAGIC = {".png": b"\x89PNG", ".svg": b"<?xml", ".pdf": b"%PDF"}


@pytest.fixture
def figure():
    drawn = new_figure(1.0, 1.0)
    drawn.add_axes((0.2, 0.2, 0.7, 0.7)).plot([0.0, 1.0], [0.0, 1.0])
    return drawn


@pytest.mark.parametrize("suffix", sorted(MAGIC))
def test_every_format_is_written_and_nothing_else(figure, tmp_path, suffix):
    path = save_figure(figure, tmp_path / f"picture{suffix.upper()}")
    assert path.read_bytes().startswith(MAGIC[suffix])
    assert [entry.name for entry in tmp_path.iterdir()] == [path.name]


@pytest.mark.parametrize("suffix", [".png", ".pdf"])
def test_the_same_figure_gives_the_same_bytes(figure, tmp_path, suffix):
    first, second = (save_figure(figure, tmp_path / f"{name}{suffix}").read_bytes() for name in "ab")
    assert first == second


@pytest.mark.parametrize("name", ["picture.jpg", "picture", "picture.png.exe", ".png"])
def test_other_formats_are_refused_with_the_remedy(figure, tmp_path, name):
    with pytest.raises(FileError, match=r"end the name in \.pdf, \.png, \.svg") as caught:
        save_figure(figure, tmp_path / name)
    assert "\n" not in str(caught.value) and not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "place", ["missing/picture.png", "file/picture.png", "folder.png", "nul\0.png", 300 * "x"]
)
def test_a_place_that_cannot_be_written_is_refused(figure, tmp_path, place):
    (tmp_path / "file").write_text("in the way")
    (tmp_path / "folder.png").mkdir()
    path = tmp_path / (place if place.endswith(".png") else f"{place}.png")
    with pytest.raises(FileError, match="name a file in a folder that exists and may be written"):
        save_figure(figure, path)
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["file", "folder.png"]


def test_a_failure_leaves_the_old_picture_and_no_scrap(figure, tmp_path, monkeypatch):
    path = tmp_path / "picture.png"
    path.write_bytes(b"old")

    def fail(self, target):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "replace", fail)
    with pytest.raises(FileError, match="No space left on device"):
        save_figure(figure, path)
    assert path.read_bytes() == b"old" and len(list(tmp_path.iterdir())) == 1


def test_a_saved_file_replaces_the_old_one(figure, tmp_path):
    path = tmp_path / "picture.png"
    path.write_bytes(b"old")
    assert save_figure(figure, path).read_bytes().startswith(MAGIC[".png"])


def test_drawing_touches_no_global_state(tmp_path):
    before = dict(mpl.rcParams)
    figure, _ = plane_figure(Ground(0.0, 1.0, 0.0, 1.0), frame="map")
    save_figure(figure, tmp_path / "picture.svg")
    assert dict(mpl.rcParams) == before


def test_pyplot_is_never_imported():
    code = "import sys, qsrlang.plotting.steps; assert 'matplotlib.pyplot' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)


def test_axes_are_to_scale_and_the_scale_bar_is_exact():
    figure, axes = plane_figure(Ground(-1.0, 6.0, 2.0, 5.0), frame="map", caption_lines=2, bars=2)
    figure.canvas.draw()
    x, y = axes.transData.transform([[0.0, 2.0], [1.0, 3.0]]).T
    assert x[1] - x[0] == pytest.approx(y[1] - y[0], rel=1e-9)
    (bar,) = (line for line in axes.lines if line.get_gid() == "scale-bar")
    assert np.ptp(bar.get_xdata()) == pytest.approx(1.0) and np.ptp(bar.get_ydata()) == 0.0
    assert axes.get_xlim() == (-1.0, 6.0) and axes.get_ylim() == (2.0, 5.0)


def test_a_thin_ground_is_widened():
    ground = Ground.around(np.array([[0.0, 0.0], [10.0, 0.0]]), 0.5)
    assert ground == Ground(-0.5, 10.5, -1.1, 1.1)


@pytest.mark.parametrize("far", [0.0, 1e9, 1e300])
def test_a_ground_without_sense_is_refused(far):
    with pytest.raises(ValueRangeError, match="a side of the ground"):
        Ground.around(np.array([[0.0, 0.0], [far, far]]), 0.0)


@pytest.mark.parametrize(
    ("extent", "length", "text"),
    [(7.5, 1.0, "1 m"), (1.65, 0.2, "20 cm"), (40.0, 10.0, "10 m"), (20.0, 5.0, "5 m")],
)
def test_scale_bars_are_round(extent, length, text):
    assert round_length(extent) == pytest.approx(length) and length_text(round_length(extent)) == text
