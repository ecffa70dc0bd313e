import os
import signal
import sqlite3
import subprocess
import sys

import numpy as np
import pytest
from learning.logs import desks

from qsrlang.errors import FileError
from qsrlang.learning.reading import read_observations
from qsrlang.learning.store import ObservationStore


def test_what_is_stored_is_asked_by_place_and_time(tmp_path):
    seen = desks(3, 4, np.random.default_rng(0))
    with ObservationStore(tmp_path / "life.sqlite") as store:
        store.append(seen)
        assert len(store) == len(seen)
        assert store.places() == ("room-0", "room-1", "room-2")
        part = store.query("room-1", start=10 * 3600.0, end=12 * 3600.0)
    assert set(part.text("place")) == {"room-1"}
    assert set(part.hours.tolist()) == {10.0, 11.0}
    assert len(read_observations(tmp_path / "life.sqlite").observations) == len(seen)


def test_another_database_is_left_alone(tmp_path):
    other = sqlite3.connect(tmp_path / "other.db")
    other.execute("CREATE TABLE mine (x)")
    other.commit()
    other.close()
    with pytest.raises(FileError, match="something else"):
        ObservationStore(tmp_path / "other.db")
    (tmp_path / "text.db").write_text("no database, but long enough to be looked at as one\n" * 40)
    with pytest.raises(FileError, match="cannot be used as a store"):
        ObservationStore(tmp_path / "text.db")


def test_a_batch_that_fails_leaves_nothing(tmp_path, monkeypatch):
    seen = desks(1, 2, np.random.default_rng(0))
    with ObservationStore(tmp_path / "life.sqlite") as store:
        store.append(seen)
        broken = iter([*zip(*(seen.text(name) for name in ("place",)), strict=True)])
        monkeypatch.setattr("qsrlang.learning.store.zip", lambda *_, **__: broken, raising=False)
        with pytest.raises(FileError):
            store.append(seen)
        monkeypatch.undo()
        assert len(store) == len(seen)


def test_a_killed_process_loses_no_batch_that_was_stored(tmp_path):
    path = tmp_path / "life.sqlite"
    code = (
        "import os, signal, sys\n"
        "import numpy as np\n"
        "from learning.logs import desks\n"
        "from qsrlang.learning.store import ObservationStore\n"
        "store = ObservationStore(sys.argv[1])\n"
        "store.append(desks(1, 3, np.random.default_rng(0)))\n"
        "store._connection.execute('BEGIN IMMEDIATE')\n"
        'store._connection.execute("DELETE FROM sightings")\n'
        "os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    environment = os.environ | {"PYTHONPATH": "tests"}
    done = subprocess.run([sys.executable, "-c", code, str(path)], env=environment, check=False)
    assert done.returncode == -signal.SIGKILL
    with ObservationStore(path) as store:
        assert len(store) == 12
