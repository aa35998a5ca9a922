"""Files stay small, and every effect, solver and shape pair is where the engine looks for it."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest
from sources import ROOT, files

from lavendersim.cell.shapes import PRIMITIVES
from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.collide.shapes import SHAPES
from lavendersim.engine.effects import CHAINED, EFFECTS, Effect, hook_names
from lavendersim.engine.records import F8, I8, U8
from lavendersim.engine.solvers import SOLVER_NAMES
from lavendersim.engine.solvers.catalogue import SOLVERS
from lavendersim.quantities.kinds import kind_of

ENGINE = ROOT / "lavendersim/engine"
LONGEST_FILE = 400  # lines; beyond it a file does more than one thing
# What several solvers are made of, and their declaration.
SHARED_BY_SOLVERS = {"catalogue", "iteration", "row_update", "solver", "step_bound", "sweep"}
# Folders of configs that claim something of physics, and what claims something else: maps look for
# where bounds break, and what the fuzz found is checked by its laws (`tests/property`).
CLAIMING = ("chapter", "hard", "paw_check", "scenes")
CLAIMING_ELSE = {"maps", "found"}


def test_no_file_is_longer_than_the_limit() -> None:
    sources = [*files(), *sorted((ROOT / "tests").rglob("*.py"))]
    lengths = {path.relative_to(ROOT): len(path.read_text().splitlines()) for path in sources}
    assert {path: length for path, length in lengths.items() if length > LONGEST_FILE} == {}


def test_a_config_says_what_every_step_keeps() -> None:
    """A default may not hold; then its number, or `none`, stands there with the reason."""
    claims = [path for folder in CLAIMING for path in (ROOT / "configs" / folder).rglob("*.yaml")]
    assert len(claims) > 80
    silent = [
        path.relative_to(ROOT)
        for path in claims
        if "\nalways:" not in path.read_text() and path.parent.name not in CLAIMING_ELSE
    ]
    assert silent == []


def test_no_two_test_files_share_a_name() -> None:
    """Pytest imports test files by their bare name."""
    names = [path.stem for path in (ROOT / "tests").rglob("test_*.py")]
    assert sorted(names) == sorted(set(names))


@pytest.mark.parametrize("file", files(), ids=lambda file: str(file.relative_to(ROOT)))
def test_a_module_says_what_it_is_for(file: Path) -> None:
    assert ast.get_docstring(ast.parse(file.read_text())), "no docstring"


def test_every_module_of_effects_is_listed_once() -> None:
    stems = {path.stem for path in (ENGINE / "effects").glob("*.py")} - {
        "__init__",
        "decision",
        "effect",
        "keys",
        "joint_models",
        "time_functions",
    }
    names = [effect.name for effect in EFFECTS]
    assert sorted(names) == sorted(stems)


@pytest.mark.parametrize("effect", EFFECTS, ids=lambda effect: effect.name)
def test_fields_and_columns_of_an_effect_can_be_stored(effect: Effect) -> None:
    own = effect.fields
    fields = [*own.body, *own.velocity, *own.pair, *own.contact, *own.cache]
    columns = [*effect.contact_columns, *effect.step_columns, *effect.residual_columns]
    for name, kind in [*fields, *((column.name, column.kind) for column in columns)]:
        assert name.isidentifier()
        assert kind in (F8, I8, U8)


@pytest.mark.parametrize("hook", [h for h in hook_names() if h not in CHAINED])
def test_a_hook_that_is_called_once_is_had_by_one_effect(hook: str) -> None:
    having = [effect.name for effect in EFFECTS if getattr(effect.hooks, hook)]
    assert len(having) == 1


def stems_of(folder: str) -> set[str]:
    return {path.stem for path in (ENGINE / folder).glob("*.py")} - {"__init__"}


def test_every_solver_is_a_file_and_a_name() -> None:
    assert stems_of("solvers") - SHARED_BY_SOLVERS == set(SOLVER_NAMES)
    assert [solver.name for solver in SOLVERS.values()] == list(SOLVER_NAMES)


# numba calls its own class with nine.
ARGUMENTS_OF_OTHERS = {("part_compiler.py", "__init__")}


def test_nothing_takes_more_than_six_arguments_by_their_place() -> None:
    """Commands of the command line are called by typer, option by option."""
    found = []
    for file in (file for file in files() if file.is_relative_to(ROOT / "lavendersim")):
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.FunctionDef):
                names = [one.arg for one in (*node.args.posonlyargs, *node.args.args)]
                count = len(names) - (names[:1] in (["self"], ["cls"]))
                if count > 6 and (file.name, node.name) not in ARGUMENTS_OF_OTHERS:
                    found.append(f"{file.name}:{node.lineno}: {node.name} takes {count}")
    assert found == []


def test_every_shape_of_a_config_has_kernels() -> None:
    named = {kind_of(model) for model in PRIMITIVES}
    assert named | {"plane", "hull", "compound", "bowl", "drum", "mesh"} == set(SHAPES)
    assert len({shape.kind for shape in SHAPES.values()}) == len(SHAPES)


def test_every_shape_pair_is_listed() -> None:
    """Pairs without a closed form share a file, with a plane, an ellipsoid or neither.

    So do a bowl and a drum with each shape.
    """
    files = {name: pair.file for name, pair in SHAPE_PAIRS.items()}
    shared = {"convex", "convex_plane", "ellipsoid_convex"}
    shared |= {pair.file for pair in SHAPE_PAIRS.values() if pair.inside}
    assert set(files.values()) | shared == stems_of("collide/pairs")
    assert all(name == file for name, file in files.items() if file not in shared)
