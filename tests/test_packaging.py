"""The wheel carries grammars/ and knowledge/, and works in a bare environment from any folder."""

import subprocess
import sys
import venv
import zipfile
from pathlib import Path

import lark
import pytest

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    folder = tmp_path_factory.mktemp("wheel")
    command = [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", str(folder), str(ROOT)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    (path,) = folder.glob("*.whl")
    return path


def test_the_wheel_holds_what_the_program_reads(wheel):
    names = set(zipfile.ZipFile(wheel).namelist())
    shipped = [
        path.relative_to(ROOT) for top in ("grammars", "knowledge") for path in (ROOT / top).rglob("*.*")
    ]
    assert {f"qsrlang/{path.as_posix()}" for path in shipped if (ROOT / path).is_file()} <= names
    assert {"qsrlang/py.typed", "qsrlang/__init__.pyi"} <= names
    assert not [name for name in names if name.startswith("tests")]


def test_the_installed_wheel_checks_a_shipped_file_from_another_folder(wheel, tmp_path):
    """The bare environment holds the wheel alone; what it depends on is lent by the running one, as PyPI would."""
    bare = tmp_path / "bare"
    venv.create(bare, with_pip=False)
    python = bare / "bin" / "python"
    pip = [
        sys.executable,
        "-m",
        "pip",
        "--python",
        str(python),
        "install",
        "--quiet",
        "--no-deps",
        "--no-index",
    ]
    subprocess.run([*pip, str(wheel)], check=True)
    site = bare / "lib" / f"python{sys.version_info.major}.{sys.version_info.minor}" / "site-packages"
    lender = Path(lark.__file__).parents[1]
    (site / "lender.pth").write_text(f"{lender}\n")
    done = subprocess.run(
        [bare / "bin" / "qsr", "check", "office/desk"], capture_output=True, text=True, cwd="/"
    )
    assert done.returncode == 0, done.stderr
    assert "office/desk: no errors" in done.stdout
    where = [python, "-c", "import qsrlang; print(qsrlang.__file__)"]
    assert subprocess.run(where, capture_output=True, text=True, cwd="/").stdout.startswith(str(site))
