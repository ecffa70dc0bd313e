import json

import pytest

MONITOR = "monitor-1 : Monitor at (0 m, 0 m) facing -90 deg"


def test_check_sums_up_what_is_known(qsr_command):
    code, out, _ = qsr_command("check", "office/desk")
    assert code == 0
    assert "office/desk: no errors; 9 classes, 9 relations, 0 landmarks, 5 related pairs" in out


def test_check_tells_every_mistake_and_exits_with_2(qsr_command, tmp_path):
    path = tmp_path / "bad.qsr"
    path.write_text("static A { size: 8 × 8 cm }.\nobserve left_of(B, B).\n")
    code, out, err = qsr_command("check", path)
    assert code == 2
    assert err.count("error[") == 4
    assert f"{path}:1:18" in err
    assert "4 errors" in out
    code, out, _ = qsr_command("check", path, "--format", "json")
    assert [finding["code"] for finding in json.loads(out)] == ["Q301", "Q203", "Q201", "Q201"]


def test_ask_prints_components_frame_and_reasons_as_json(qsr_command):
    code, out, _ = qsr_command("ask", "office/desk", "where Cup?", "--landmark", MONITOR, "--format", "json")
    answer = json.loads(out)
    assert code == 0
    assert answer["frame"] == "map"
    assert [round(component["weight"], 12) for component in answer["components"]] == [0.85, 0.15]
    assert "office/desk.qsr:27" in answer["components"][0]["statements"][-1]
    assert len(answer["components"][0]["covariance"]) == 2


def test_ask_prints_a_table(qsr_command):
    code, out, _ = qsr_command("ask", "office/desk", "where Cup wrt Keyboard?")
    assert code == 0
    for word in (
        "weight",
        "[m]",
        "0.850",
        "0.150",
        "frame: Keyboard",
        "observe 85 × right-of(Cup, Keyboard)",
    ):
        assert word in out


def test_ask_by_sampling_repeats_with_its_seed(qsr_command):
    words = (
        "ask",
        "office/desk",
        "where Cup?",
        "--engine",
        "sampling",
        "--samples",
        "500",
        "--format",
        "json",
    )
    assert qsr_command(*words, "--seed", "4") == qsr_command(*words, "--seed", "4")
    assert qsr_command(*words, "--seed", "4") != qsr_command(*words, "--seed", "5")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("ask", "office/desk", "where Cupp?"), "did you mean 'Cup'"),
        (("ask", "office/dsk", "where Cup?"), "shipped are"),
        (("ask", "nowhere.qsr", "where Cup?"), "nowhere.qsr"),
        (("ask", "office/desk", "where Cup"), None),
        (("ask", "office/desk", "wher Cup?"), "Q101"),
        (("ask", "office/desk", "where Cup?", "--landmark", "m Monitor at (0 m, 0 m)"), "Q101"),
        (("ask", "office/desk", "where Cup?", "--engine", "magic"), "unknown engine"),
        (("ask", "office/desk", "where Cup?", "--viewer", "here"), "Q101"),
        (("plot", "office/desk", "where Cup?", "-o", "picture.xyz"), "picture.xyz"),
        (("check", "nowhere.qsr"), "nowhere.qsr"),
    ],
)
def test_bad_input_is_told_in_words_with_exit_code_2(qsr_command, words, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, _, err = qsr_command(*words)
    if message is None:
        assert code == 0
    else:
        assert code == 2
        assert message in err
    assert list(tmp_path.iterdir()) == []


def test_plot_writes_a_picture(qsr_command, tmp_path):
    path = tmp_path / "cup.png"
    code, out, _ = qsr_command("plot", "office/desk", "where Cup wrt Keyboard?", "-o", path)
    assert code == 0
    assert path.read_bytes().startswith(b"\x89PNG")
    assert "2 components" in out
