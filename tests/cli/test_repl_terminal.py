"""The REPL in a real terminal: keys go in, and what the screen shows is read off it."""

import os
import signal
import sys
import time
from pathlib import Path

import pexpect
import pyte
import pytest

import qsrlang

ROWS, COLUMNS = 50, 100
PATIENCE = 60.0
COMMAND = "from qsrlang.cli.main import main; main()"
TAB, UP, CTRL_C, CTRL_D, ENTER = "\t", "\x1b[A", "\x03", "\x04", "\r"
CHAIN = 13

pytestmark = [
    pytest.mark.skipif(sys.platform == "win32", reason="needs a pseudo-terminal"),
    pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning"),
]


class _Screen(pyte.Screen):
    """A screen that answers when the program asks where the cursor is."""

    def __init__(self, answer):
        super().__init__(COLUMNS, ROWS)
        self.write_process_input = answer


class Terminal:
    """A terminal with `qsr ...` running in it."""

    def __init__(self, folder, *words):
        paths = [str(Path(qsrlang.__file__).parents[1]), os.environ.get("PYTHONPATH", "")]
        settings = {
            "TERM": "xterm-256color",
            "XDG_STATE_HOME": str(folder / "state"),
            "PYTHONPATH": os.pathsep.join(filter(None, paths)),
        }
        self.child = pexpect.spawn(
            sys.executable,
            ["-c", COMMAND, *words],
            env={**os.environ, **settings},
            cwd=str(folder),
            dimensions=(ROWS, COLUMNS),
            encoding="utf-8",
        )
        self.child.delaybeforesend = None
        self._screen = _Screen(self.child.send)
        self._stream = pyte.Stream(self._screen)

    @property
    def lines(self):
        return [line.rstrip() for line in self._screen.display if line.strip()]

    def type(self, *keys):
        self.child.send("".join(keys))

    def wait(self, is_so, press=""):
        """Read until the lines of the screen are as they should be, pressing a key over and over."""
        end = time.monotonic() + PATIENCE
        while not is_so(self.lines):
            assert time.monotonic() < end, "\n".join(self.lines)
            try:
                self.type(press)
                self._stream.feed(self.child.read_nonblocking(65536, timeout=0.2))
            except pexpect.TIMEOUT:
                continue
            except pexpect.EOF:
                self.child.wait()
                assert is_so(self.lines), "\n".join(self.lines)

    def wait_for(self, text):
        self.wait(lambda lines: any(text in line for line in lines))

    def wait_for_input(self, text="", press=""):
        """Read until the line with the cursor ends with the prompt and this input."""
        wanted = f"qsr> {text}".rstrip()
        self.wait(lambda lines: self._screen.display[self._screen.cursor.y].rstrip().endswith(wanted), press)

    def wait_for_end(self):
        self.wait(lambda lines: not self.child.isalive())
        self.child.close()
        assert not any("Traceback" in line for line in self.lines)
        return self.child.exitstatus


@pytest.fixture
def terminal(tmp_path):
    opened = []

    def open_one(*words):
        opened.append(Terminal(tmp_path, *words))
        return opened[-1]

    yield open_one
    for one in opened:
        one.child.close(force=True)


@pytest.fixture
def endless(tmp_path):
    """Knowledge in which a query takes very long: a chain of many alternatives."""
    names = [f"B{number}" for number in range(CHAIN)]
    lines = ["static A.", f"dynamic {', '.join(names)}.", "landmark a-1 : A at (0 m, 0 m) facing 0 deg."]
    for before, name in zip(["A", *names], names, strict=False):
        lines.append(f"believe 0.5 :: left-of({name}, {before}) | 0.5 :: right-of({name}, {before}).")
    (tmp_path / "endless.qsr").write_text("\n".join(lines))
    return f"where {names[-1]}?"


def kept_in(folder):
    (path,) = (folder / "state" / "qsr").glob("kept-*.qsr")
    return path


def test_a_session(terminal, tmp_path, qsr_command):
    one = terminal("repl", "office/desk")
    one.wait_for_input()
    assert one.lines[0].startswith("qsr ")
    assert "office/desk: 9 classes" in one.lines[0]

    one.type("where K", TAB)
    one.wait_for_input("where Keyboard")
    one.type("?", ENTER)
    one.wait_for("frame: Monitor")
    one.wait_for_input()
    assert any("▀" in line for line in one.lines)

    one.type("observe 3 ×", ENTER)
    one.wait_for("...>")
    one.type("right-of(Mug, Keyboard).", ENTER)
    one.wait_for("unknown class 'Mug'")
    one.wait_for_input()
    one.type("dynamic Mug.", ENTER)
    one.wait_for("added as line 2")
    one.type(UP, UP)
    one.wait_for("...> right-of(Mug, Keyboard).")
    one.type(ENTER)
    one.wait_for("added as lines 3 to 4")
    one.type(":undo", ENTER)
    one.wait_for("- right-of(Mug, Keyboard).")

    one.type(":save mine.qsr", ENTER)
    one.wait_for("saved to mine.qsr")
    one.wait_for_input()
    one.type(CTRL_D)
    assert one.wait_for_end() == 0
    assert (tmp_path / "mine.qsr").read_text() == 'import "office/desk".\ndynamic Mug.\n'
    assert qsr_command("check", tmp_path / "mine.qsr")[0] == 0
    assert not list((tmp_path / "state" / "qsr").glob("kept-*"))
    assert "+where Keyboard?" in (tmp_path / "state" / "qsr" / "history").read_text()


def test_ctrl_c_clears_the_input_and_leaving_asks_once(terminal, tmp_path):
    one = terminal("repl")
    one.wait_for_input()
    one.type("static Ha")
    one.wait_for_input("static Ha")
    one.type(CTRL_C)
    one.wait_for_input()
    one.type(CTRL_C, CTRL_C)
    one.wait_for_input("static Ha", press=UP)
    one.type("t.", ENTER)
    one.wait_for("added as line 1")
    one.type(CTRL_D)
    one.wait_for("1 statement is not saved")
    one.wait_for_input()
    one.type(CTRL_D)
    assert one.wait_for_end() == 0
    kept = kept_in(tmp_path)
    assert kept.name in "".join(one.lines)
    assert kept.read_text().endswith("\nstatic Hat.\n")


def test_ctrl_c_stops_an_answer_and_a_hangup_the_session(terminal, tmp_path, endless):
    one = terminal("repl", "endless.qsr")
    one.wait_for_input()
    one.type("static Hat.", ENTER)
    one.wait_for("added as line 17")
    one.wait_for_input()
    one.type(endless, ENTER)
    one.wait(lambda lines: any("interrupted" in line for line in lines), press=CTRL_C)
    one.wait_for_input()
    one.type(":list", ENTER)
    one.wait_for("17 * static Hat.")
    one.wait_for_input()
    one.type(endless, ENTER)
    one.wait(lambda lines: sum(endless in line for line in lines) == 2)
    one.child.kill(signal.SIGHUP)
    assert one.wait_for_end() == 128 + signal.SIGHUP
    assert "static Hat." in kept_in(tmp_path).read_text()


def test_a_file_is_mended_and_a_killed_session_kept(terminal, tmp_path):
    (tmp_path / "bad.qsr").write_text("static A")
    one = terminal("repl", "bad.qsr")
    one.wait_for("error[Q104]")
    one.wait_for_input()
    (tmp_path / "bad.qsr").write_text("static A.")
    one.type(":reload", ENTER)
    one.wait_for("loaded bad.qsr")
    one.wait_for_input()
    one.type("static Hat.", ENTER)
    one.wait_for("added as line 2")
    one.wait_for_input()
    one.child.kill(signal.SIGTERM)
    assert one.wait_for_end() == 128 + signal.SIGTERM
    assert "static A.\nstatic Hat." in kept_in(tmp_path).read_text()
