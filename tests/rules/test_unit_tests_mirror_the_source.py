"""Every unit test stands where its subject does, and begins with its name.

    lavendersim/trace/writer.py      tests/unit/trace/test_writer.py, test_writer_read_by_rerun.py
    lavendersim/engine/collide/pairs tests/unit/engine/collide/test_pairs_swapped.py

A law of several packages is no unit's: it stands in tests/physics, tests/runner or their like.
"""

from __future__ import annotations

from pathlib import Path

import pytest
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
