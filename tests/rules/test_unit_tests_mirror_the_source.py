"""Every unit test stands where its subject does, and begins with its name.

    lavendersim/trace/writer.py      tests/unit/trace/test_writer.py, test_writer_read_by_rerun.py
    lavendersim/engine/collide/pairs tests/unit/engine/collide/test_pairs_swapped.py

A law of several packages is no unit's: it stands in tests/physics, tests/runner or their like.
Every module has a test that is named after it, or is a declaration.
"""

from __future__ import annotations

import ast
from pathlib import Path

import pytest
from declarations import DECLARATIONS
from sources import ROOT

PACKAGE = ROOT / "lavendersim"
UNIT = ROOT / "tests/unit"


def subject_of(test: Path) -> Path | None:
    """Return the module or package that a test is named after: the longest name that there is."""
    room = PACKAGE / test.parent.relative_to(UNIT)
    words = test.stem.removeprefix("test_").split("_")
    for count in range(len(words), 0, -1):
        name = "_".join(words[:count])
        for subject in (room / f"{name}.py", room / name / "__init__.py"):
            if subject.is_file():
                return subject
    return None


def test_every_unit_test_is_named_after_a_module_beside_it() -> None:
    tests = sorted(UNIT.rglob("test_*.py"))
    assert len(tests) > 140
    strays = [str(test.relative_to(UNIT)) for test in tests if subject_of(test) is None]
    assert strays == []


@pytest.mark.parametrize(
    ("test", "subject"),
    [
        ("trace/test_writer.py", "trace/writer.py"),
        ("trace/test_contact_columns_derived.py", "trace/contact_columns.py"),
        ("engine/collide/test_pairs_swapped.py", "engine/collide/pairs/__init__.py"),
        ("trace/test_write.py", None),
        ("replay/test_writer.py", None),
        ("trace/test_writers.py", None),
    ],
)
def test_a_subject_is_found_by_whole_words_in_the_same_package(
    test: str, subject: str | None
) -> None:
    assert subject_of(UNIT / test) == (PACKAGE / subject if subject else None)


def test_every_file_of_tests_has_a_name_of_its_own() -> None:
    """Pytest imports them by it: of two `test_solids.py` it refuses one, and nothing is run."""
    names = [test.name for test in (ROOT / "tests").rglob("test_*.py")]
    assert sorted({name for name in names if names.count(name) > 1}) == []


def has_functions(module: Path) -> bool:
    """Return whether a module defines a function, a method or a lambda."""
    kinds = (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)
    return any(isinstance(node, kinds) for node in ast.walk(ast.parse(module.read_text())))


def untested(modules: set[Path], tests: set[Path], excused: set[Path]) -> list[Path]:
    """Return what is wrong: modules without a test or an excuse, and excuses that are no longer so.

    An excuse is no longer so where a test is named after its module, or where the module is gone.
    """
    subjects = {subject_of(test) for test in tests}
    return sorted((modules - subjects - excused) | (excused & subjects) | (excused - modules))


def test_every_module_has_a_unit_test_or_is_a_declaration() -> None:
    modules = {file for file in PACKAGE.rglob("*.py") if file.name != "__init__.py"}
    declarations = {PACKAGE / name for name in DECLARATIONS}
    wrong = untested(modules, set(UNIT.rglob("test_*.py")), declarations)
    assert [str(module.relative_to(PACKAGE)) for module in wrong] == []


@pytest.mark.parametrize("name", DECLARATIONS)
def test_a_declaration_has_no_function(name: str) -> None:
    assert not has_functions(PACKAGE / name)


def test_a_missing_test_and_an_excuse_too_many_are_found() -> None:
    writer, reader, gone = (PACKAGE / f"trace/{name}.py" for name in ("writer", "reader", "gone"))
    tests = {UNIT / "trace/test_writer_read_by_rerun.py"}
    assert untested({writer, reader}, tests, {reader}) == []
    assert untested({writer, reader}, tests, set()) == [reader]
    assert untested({writer, reader}, tests, {writer, reader}) == [writer]
    assert untested({writer, reader}, tests, {reader, gone}) == [gone]
