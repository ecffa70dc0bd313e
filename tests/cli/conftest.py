import sys

import pytest

from qsrlang.cli.main import main


@pytest.fixture
def qsr_command(monkeypatch, capsys):
    """Run `qsr` as a user would: returns exit code, standard output and standard error."""

    def run(*words):
        monkeypatch.setattr(sys, "argv", ["qsr", *map(str, words)])
        try:
            main()
            code = 0
        except SystemExit as stop:
            code = stop.code or 0
        printed = capsys.readouterr()
        assert "Traceback" not in printed.err + printed.out
        return code, printed.out, printed.err

    return run
