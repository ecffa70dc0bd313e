"""The house: which layer may import which, and what each library is for."""

import ast
from pathlib import Path

import pytest

import qsrlang

PACKAGE = Path(qsrlang.__file__).parent

# Low to high; names on one line are siblings and never import each other.
LAYERS = [
    {"errors"},
    {"arrays", "files", "resources"},
    {"language", "geometry"},
    {"relations", "maps"},
    {"mixtures"},
    {"planning"},
    {"simulation", "learning", "plotting", "editor"},
    {"experiments"},
    {"cli"},
]
HOMES = {
    "lark": {"language"},
    "pybullet": {"simulation"},
    "sklearn": {"learning"},
    "matplotlib": {"plotting"},
    "dask": {"experiments"},
    "typer": {"cli"},
    "prompt_toolkit": {"cli"},
    "pygls": {"editor"},
    "lsprotocol": {"editor"},
    "pygments": {"editor", "cli"},
}
LEVEL = {name: level for level, names in enumerate(LAYERS) for name in names}
MODULES = sorted(path for path in PACKAGE.rglob("*.py") if path != PACKAGE / "__init__.py")
MAX_LINES = 300


def imports_of(path: Path) -> set[str]:
    """Every imported module, function bodies included."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import"
            found.add(str(node.module))
            found.update(f"{node.module}.{alias.name}" for alias in node.names)
    return found


def layer_of(path: Path) -> str:
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


@pytest.mark.parametrize("path", MODULES, ids=lambda path: path.relative_to(PACKAGE).as_posix())
def test_imports_point_down(path):
    own = layer_of(path)
    for name in imports_of(path):
        parts = name.split(".")
        if parts[0] == "qsrlang" and len(parts) > 1 and parts[1] in LEVEL:
            other = parts[1]
            assert other == own or LEVEL[other] < LEVEL[own], f"{own} imports {name}"
        if parts[0] in HOMES:
            assert own in HOMES[parts[0]], f"{own} imports {name}"


@pytest.mark.parametrize("path", MODULES, ids=lambda path: path.relative_to(PACKAGE).as_posix())
def test_modules_are_small_and_imports_stand_at_the_top(path):
    text = path.read_text(encoding="utf-8")
    assert text.count("\n") <= MAX_LINES
    functions = [n for n in ast.walk(ast.parse(text)) if isinstance(n, ast.FunctionDef)]
    inner = [n for f in functions for n in ast.walk(f) if isinstance(n, ast.Import | ast.ImportFrom)]
    assert not inner, "an import inside a function"


def test_every_folder_has_a_layer():
    assert {layer_of(path) for path in MODULES} <= set(LEVEL)


def test_no_catch_all_names():
    refused = {"utils", "util", "common", "helpers", "helper", "manager", "config", "misc", "base"}
    names = {part.removesuffix(".py") for path in MODULES for part in path.relative_to(PACKAGE).parts}
    assert not names & refused


def test_public_names_are_what_the_stub_says():
    for name in qsrlang.__all__:
        assert getattr(qsrlang, name) is not None
    assert set(qsrlang.__all__) <= set(dir(qsrlang))
    stub = ast.parse((PACKAGE / "__init__.pyi").read_text(encoding="utf-8"))
    (listed,) = [ast.literal_eval(node.value) for node in stub.body if isinstance(node, ast.Assign)]
    assert sorted(listed) == sorted(qsrlang.__all__)


def test_public_names_have_docstrings():
    undocumented = [n for n in qsrlang.__all__ if not (getattr(qsrlang, n).__doc__ or "").strip()]
    assert not undocumented
