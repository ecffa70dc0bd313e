import io
import json

import pytest

from qsrlang.relations.linting.lint import RULES

LOOSE = "dynamic Cup,Plate. # small things\r\nobserve 3*left-of(Cup,Plate)&close-to(Cup,Plate).\r\n"
TIDY = "dynamic Cup, Plate.  # small things\nobserve 3 × left-of(Cup, Plate) ∧ close-to(Cup, Plate).\n"
ASCII = TIDY.replace("×", "x").replace("∧", "and")
WRONG = "dynamic   Cup.\nobserve left-of(Cup Plate).\nobserve left of(Cup).\n"


@pytest.fixture
def file(tmp_path):
    def write(text, name="a.qsr"):
        path = tmp_path / name
        path.write_bytes(text.encode())
        return path

    return write


def test_a_file_is_put_into_form_once(qsr_command, file):
    path = file(LOOSE)
    assert qsr_command("fmt", path) == (0, f"formatted {path}\n", "")
    assert path.read_bytes().decode() == TIDY
    assert qsr_command("fmt", path) == (0, "", "")
    assert qsr_command("fmt", path, "--check") == (0, "", "")


def test_both_spellings(qsr_command, file):
    path = file(TIDY)
    assert qsr_command("fmt", "--ascii", path)[0] == 0
    assert path.read_text() == ASCII
    assert qsr_command("fmt", "--unicode", path)[0] == 0
    assert path.read_text() == TIDY


def test_check_shows_a_difference_and_writes_nothing(qsr_command, file):
    path = file(LOOSE.replace("\r\n", "\n").rstrip("\n"))
    before = path.read_bytes()
    code, shown, _ = qsr_command("fmt", "--check", path)
    assert (code, path.read_bytes()) == (1, before)
    assert shown.splitlines() == [
        f"--- {path}",
        f"+++ {path}",
        "@@ -1,2 +1,2 @@",
        "-dynamic Cup,Plate. # small things",
        "-observe 3*left-of(Cup,Plate)&close-to(Cup,Plate).",
        "\\ No newline at end of file",
        "+dynamic Cup, Plate.  # small things",
        "+observe 3 × left-of(Cup, Plate) ∧ close-to(Cup, Plate).",
    ]


def test_check_tells_where_only_the_line_ends_differ(qsr_command, file):
    path = file(TIDY.replace("\n", "\r\n"))
    assert qsr_command("fmt", "--check", path) == (
        1,
        f"{path}: the lines would end in LF instead of CRLF\n",
        "",
    )


def test_a_file_with_errors_is_left_alone_and_stops_no_other(qsr_command, file):
    wrong, loose = file(WRONG), file(LOOSE, "b.qsr")
    code, shown, errors = qsr_command("fmt", wrong, loose)
    assert (code, shown) == (2, f"formatted {loose}\n")
    assert errors.count("error[Q101]") == 2
    assert f"{wrong}: not formatted, because of the errors above" in errors
    assert wrong.read_text() == WRONG
    assert loose.read_text() == TIDY


def test_a_missing_file_stops_no_other(qsr_command, file, tmp_path):
    loose = file(LOOSE)
    code, shown, errors = qsr_command("fmt", tmp_path / "none.qsr", loose)
    assert (code, shown) == (2, f"formatted {loose}\n")
    assert errors.startswith(f"error: {tmp_path / 'none.qsr'}: No such file")


def test_a_shipped_file_may_be_checked_but_is_not_written(qsr_command):
    assert qsr_command("fmt", "office/desk") == (
        2,
        "",
        "error: office/desk: is shipped with the program; copy it to a place of your own and format that\n",
    )
    assert qsr_command("fmt", "--check", "office/desk")[0] in (0, 1)


def test_standard_input_goes_to_standard_output(qsr_command, monkeypatch):
    def typed(content):
        monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(content)))

    typed(LOOSE.encode())
    assert qsr_command("fmt", "-") == (0, TIDY, "")
    typed(WRONG.encode())
    code, shown, errors = qsr_command("fmt", "-")
    assert (code, shown) == (2, "")
    assert "<stdin>:2:21" in errors
    typed(b"dynamic \xff.")
    assert qsr_command("fmt", "-") == (
        2,
        "",
        "error: <stdin>: is not UTF-8 text (byte 8); save it as UTF-8\n",
    )


def test_lint_tells_nothing_of_a_clean_file(qsr_command, file):
    path = file("dynamic Cup, Plate.\nobserve left-of(Cup, Plate).\n")
    assert qsr_command("lint", path) == (0, f"{path}: nothing to mend\n", "")


def test_lint_tells_warnings_in_the_order_of_the_text(qsr_command, file):
    path = file("dynamic cup, Plate, Spoon.\nbelieve 0.5 :: left-of(cup, Plate).\n")
    code, shown, _ = qsr_command("lint", path)
    assert code == 1
    assert [line[8:12] for line in shown.splitlines() if line.startswith("warning")] == [
        "Q511",
        "Q503",
        "Q504",
    ]
    assert shown.endswith(f"{path}: 3 warnings\n")


def test_lint_tells_what_check_tells_too(qsr_command, file):
    path = file("dynamic Cup.\nobserve left-of(Cup, Plat).\nscene(Cup, Pen) ⇔ left-of(Cup, Pen).\n")
    code, shown, _ = qsr_command("lint", path)
    assert code == 2
    assert "error[Q201]" in shown
    assert "warning[Q502]" in shown
    assert shown.endswith(f"{path}: 1 error, 1 warning\n")


def test_lint_as_json(qsr_command, file):
    path = file("dynamic Cup, Plate.\nbelieve 0.5 :: left-of(Cup, Plate).\n")
    code, shown, _ = qsr_command("lint", path, "--format", "json")
    (finding,) = json.loads(shown)
    assert code == 1
    assert (finding["code"], finding["line"], finding["severity"]) == ("Q504", 2, "warning")
    assert finding["edits"][0]["text"] == " | elsewhere"


def test_lint_lists_its_rules(qsr_command):
    code, shown, _ = qsr_command("lint", "--rules")
    assert code == 0
    assert all(rule.code in shown for rule in RULES)
    listed = json.loads(qsr_command("lint", "--rules", "--format", "json")[1])
    assert [(one["code"], one["reason"]) for one in listed] == [(rule.code, rule.reason) for rule in RULES]


def test_lint_needs_a_file(qsr_command):
    code, _, errors = qsr_command("lint")
    assert code == 2
    assert "name a file" in errors


def test_lint_knows_what_a_viewer_sees(qsr_command, file):
    path = file("dynamic Cup.\nstatic Armchair { front: yes }.\nobserve behind-of(Cup, Armchair).\n")
    stands = ("--landmark", "old : Armchair at (0 m, 0 m) facing -90 deg")
    assert qsr_command("lint", path, *stands, "--viewer", "0 m, -2 m")[0] == 0
    code, shown, _ = qsr_command("lint", path, *stands, "--viewer", "0 m, 2 m")
    assert code == 1
    assert "warning[Q514]: 'behind-of' of 'old' is 180 deg off" in shown
    code, _, errors = qsr_command(
        "lint", path, "--landmark", "x : Sofa at (0 m, 0 m)", "--viewer", "0 m, 2 m"
    )
    assert code == 2
    assert "Sofa" in errors
