import json

import numpy as np
from learning.logs import desks

from qsrlang.learning.formats.tables import write_observations


def test_a_log_becomes_knowledge_and_what_changed_is_told(qsr_command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_observations(desks(5, 4, np.random.default_rng(0)), tmp_path / "log.csv")
    with (tmp_path / "log.csv").open("a") as file:
        file.write("0,room-0,x,Mug,Mug,1e36,0,0,,0.1,0.1,0.1,Desk,log,1\n")
    code, out, err = qsr_command("learn", "log.csv", "--into", "desk.qsr", "--aside", "aside.jsonl")
    assert code == 0, err
    assert "80 sightings used, 1 set aside: 1 further away than 1000 m" in out
    assert "from 80 sightings at 5 places" in out
    assert "1e36" in (tmp_path / "aside.jsonl").read_text()
    for words in (("check", "desk.qsr"), ("lint", "desk.qsr"), ("fmt", "--check", "desk.qsr")):
        assert qsr_command(*words)[0] == 0, words
    (tmp_path / "old.qsr").write_text("static Keyboard. dynamic Mouse. observe left-of(Mouse, Keyboard).\n")
    code, out, _ = qsr_command("diff", "old.qsr", "desk.qsr")
    assert code == 0 and "Mouse from Keyboard" in out and "% →" in out and "bits" in out
    code, out, _ = qsr_command("diff", "old.qsr", "desk.qsr", "--format", "json")
    assert json.loads(out)[0]["pair"] == ["Mouse", "Keyboard"]
    assert qsr_command("diff", "desk.qsr", "desk.qsr")[1] == "nothing changed\n"


def test_contexts_and_files_that_make_no_sense_are_told(qsr_command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_observations(desks(4, 2, np.random.default_rng(0)), tmp_path / "log.csv")
    code, _, err = qsr_command("learn", "log.csv", "--into", "desk.qsr", "--by", "rooms")
    assert code == 2 and "did you mean 'room'?" in err
    code, _, err = qsr_command("learn", "log.csv", "--into", "desk.txt")
    assert code == 2 and "does not end in .qsr" in err
    code, _, err = qsr_command("learn", "none.csv", "--into", "desk.qsr")
    assert code == 2 and "is no file" in err
    assert not (tmp_path / "desk.qsr").exists()


def test_a_log_that_tells_too_little_says_so(qsr_command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_observations(desks(1, 2, np.random.default_rng(0)), tmp_path / "log.jsonl")
    code, out, _ = qsr_command("learn", "log.jsonl", "--into", "desk.qsr")
    assert code == 0 and "too little yet" in out
    assert qsr_command("check", "desk.qsr")[0] == 0
