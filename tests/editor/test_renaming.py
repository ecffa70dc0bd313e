"""New names, and all that must stay as it is."""

from pathlib import Path

import pytest

from qsrlang.editor.diagnosing import findings_by_address
from qsrlang.editor.navigation import thing_at
from qsrlang.editor.renaming import RenamingError, rename
from qsrlang.editor.workbench import Workbench
from qsrlang.language.fixing import edited
from qsrlang.language.grammar import keywords

CORPUS = Path(__file__).parents[1] / "corpus"
PROGRAMS = sorted((CORPUS / "accepted").glob("*.qsr"))
NEW = "Ganz-Neu"


def bench_of(*paths):
    bench = Workbench()
    for path in paths:
        bench.put(path.as_uri(), path.read_text(encoding="utf-8-sig"))
    return bench


def renamed(bench, address, offset, new):
    """The text at an address with the thing at an offset renamed."""
    thing = thing_at(bench, address, offset)
    assert thing is not None
    source = bench.source(address)
    edits = rename(thing, new, bench.readings())
    return edited(source.text, [edit for edit in edits if edit.span.source is source])


@pytest.mark.parametrize("path", PROGRAMS[::4], ids=lambda path: path.stem)
def test_a_new_name_changes_nothing_else(path):
    """The findings stay, all places change, and the old name brings the old text back."""
    bench, address = bench_of(path), path.as_uri()
    text = bench.source(address).text
    before = [finding.code for finding in bench.built(address).diagnostics]
    own = [one for one in bench.reading(address).names if one.span.source is bench.source(address)]
    for one in own:
        if not one.defines or one.kind == "default" or one.span.text in keywords():
            continue
        bench.put(address, text)
        small = one.span.text[0].islower()
        changed = renamed(bench, address, one.span.start, NEW.lower() if small else NEW)
        bench.put(address, changed)
        assert [finding.code for finding in bench.built(address).diagnostics] == before
        start = changed.casefold().index(NEW.casefold())
        assert renamed(bench, address, start, one.span.text) == text


@pytest.fixture
def files(tmp_path):
    contents = {
        "base.qsr": "dynamic Cup, Plate.\nrelation near(a, b) { distance: uniform(0 cm, 30 cm) }.\n",
        "one.qsr": 'import "base.qsr".\nobserve near(Cup, Plate).\n',
        "two.qsr": 'import "base.qsr" as b.\nobserve b.near(b.Cup, b.Plate).\n',
        "both.qsr": 'import "base.qsr".\nimport "base.qsr" as b.\nobserve near(Cup, b.Cup).\n',
    }
    for name, text in contents.items():
        (tmp_path / name).write_text(text)
    return tmp_path


def test_the_same_thing_under_several_prefixes(files):
    paths = [files / name for name in ("base.qsr", "one.qsr", "two.qsr", "both.qsr")]
    bench = bench_of(*paths)
    thing = thing_at(bench, paths[1].as_uri(), paths[1].read_text().index("Cup"))
    assert thing is not None
    assert sorted((one.span.source.name, one.span.text) for one in thing.places) == [
        ("base.qsr", "Cup"),
        ("both.qsr", "Cup"),
        ("both.qsr", "Cup"),
        ("one.qsr", "Cup"),
        ("two.qsr", "Cup"),
    ]
    assert renamed(bench, paths[2].as_uri(), paths[2].read_text().index("near"), "by") == (
        'import "base.qsr" as b.\nobserve b.by(b.Cup, b.Plate).\n'
    )


def test_a_name_that_another_file_uses_is_not_free(files):
    (files / "one.qsr").write_text('import "base.qsr".\nstatic Mug.\nobserve near(Cup, Plate).\n')
    bench = bench_of(files / "base.qsr", files / "one.qsr")
    thing = thing_at(bench, (files / "base.qsr").as_uri(), len("dynamic "))
    assert thing is not None
    with pytest.raises(RenamingError, match=r"'Mug' is used already \(one\.qsr:2:8\)"):
        rename(thing, "Mug", bench.readings())


def test_what_is_wrong_between_two_files_is_shown_in_the_open_one(files):
    path = files / "clash.qsr"
    path.write_text('import "base.qsr".\nstatic Cup.\n')
    shown = findings_by_address(bench_of(path))
    here = [(one.code, one.span.text) for one in shown[path.as_uri()]]
    assert here == [("Q205", "Cup")]
    assert (files / "base.qsr").resolve().as_uri() not in shown
