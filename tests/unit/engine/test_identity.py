"""A kernel's identity changes with everything its code depends on, and with nothing else.

What two kernels compile to is not compared here (`test_edited_engine` does); here it is what they
are made of, one thing changed at a time.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numba import from_dtype, types

from lavendersim.engine.compile import inner
from lavendersim.engine.identity import UnidentifiableError, identity, seen_of
from lavendersim.engine.step import make_advance
from lavendersim.experiment import load_experiment
from lavendersim.scene.plan import plan_of_cell

CONFIGS = Path(__file__).parents[3] / "configs"
SOURCE = """
from math import sqrt
FACTOR = 2.0
TABLE = np.array([1.0, 2.0])
@inner
def half(x):
    return 0.5 * x
def make(flag, field):
    def whole(row, x):
        if flag:
            row[field] = half(x) * FACTOR
        return sqrt(x) + TABLE[0]
    return inner(whole)
kernel = make(True, "weight")
"""


def made_from(source: str) -> Any:
    """Return the kernel of a module that is made from a text."""
    module = {"__name__": "made", "np": np, "inner": inner}
    exec(source, module)
    return module["kernel"]


def digest(source: str = SOURCE) -> str:
    return identity(made_from(source)).digest


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("FACTOR = 2.0", "FACTOR = 2"),  # a constant's type is a part of the code's types
        ("FACTOR = 2.0", "FACTOR = -2.0"),
        ("TABLE = np.array([1.0, 2.0])", "TABLE = np.array([1.0, 3.0])"),
        ("0.5 * x", "0.25 * x"),  # in what it calls
        ("sqrt(x) +", "sqrt(x) -"),
        ("from math import sqrt", "from math import cos as sqrt"),
        ("make(True,", "make(False,"),
        ('"weight"', '"height"'),
        ("def whole(row, x):", "def whole(row, x=1.0):"),
    ],
)
def test_what_the_code_depends_on_changes_it(old: str, new: str) -> None:
    assert old in SOURCE
    assert digest(SOURCE.replace(old, new)) != digest()


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("FACTOR = 2.0", "FACTOR = 2.0\nOTHER = 3.0  # which no kernel reads"),
        ("return 0.5", "# a word\n    return 0.5"),
        ("def make(", "\n\n\ndef make("),
    ],
)
def test_what_it_does_not_depend_on_leaves_it(old: str, new: str) -> None:
    assert old in SOURCE
    assert digest(SOURCE.replace(old, new)) == digest()


def seen(kernel: Any, *layout: tuple[str, str]) -> str:
    """Return what a kernel sees of a row of some layout."""
    return seen_of((from_dtype(np.dtype(list(layout))),), identity(kernel))


def test_of_a_record_only_fields_that_are_named_are_seen() -> None:
    field = "y"

    def reads(row):
        return row.x + row[field]

    kernel = inner(reads)
    alone = seen(kernel, ("x", "f8"), ("y", "f8"))
    assert seen(kernel, ("x", "f8"), ("y", "f8"), ("z", "f8")) == alone
    assert seen(kernel, ("y", "f8"), ("x", "f8")) != alone  # other offsets
    assert seen(kernel, ("x", "f8"), ("y", "i8")) != alone  # another type


def test_a_field_that_a_called_kernel_names_is_seen() -> None:
    def read(row):
        return row.z

    called = inner(read)

    def reads(row):
        return called(row)

    kernel = inner(reads)
    assert seen(kernel, ("x", "f8"), ("z", "f8")) != seen(kernel, ("z", "f8"), ("x", "f8"))


def test_where_rows_are_copied_or_counted_their_size_is_seen() -> None:
    def copies(rows):
        rows[0] = rows[1]

    def reads(rows):
        return rows[1].x

    def row_of(*layout: tuple[str, str]) -> Any:
        return types.Array(from_dtype(np.dtype(list(layout))), 1, "C")

    short, long = row_of(("x", "f8")), row_of(("x", "f8"), ("y", "f8"))
    for function in (copies, reads):
        of = identity(inner(function))
        assert seen_of((short,), of) != seen_of((long,), of)


def test_a_kernel_that_calls_itself_has_none() -> None:
    source = "def f(n):\n    return 1 if n == 0 else n * kernel(n - 1)\nkernel = inner(f)\n"
    with pytest.raises(UnidentifiableError):
        identity(made_from(source))


def test_every_kernel_of_every_config_has_one() -> None:
    """One that had none would be compiled anew in every process, and with it all that call it."""
    specs = {
        plan_of_cell(load_experiment(path).cells()[0]).spec
        for folder in ("chapter", "scenes", "effects", "time")
        for path in sorted((CONFIGS / folder).glob("*.yaml"))
    }
    digests = {identity(make_advance(spec)).digest for spec in specs}
    assert len(digests) == len(specs)


def test_kernels_of_substeps_have_one_whether_bodies_sleep_or_not() -> None:
    """`accuracy` is a plan that runs for long; without a key each of its runs compiled it anew."""
    (cell, *_) = load_experiment(CONFIGS / "time/accuracy_of_rolling.yaml").cells()
    spec = plan_of_cell(cell).spec
    assert spec.has("error_control")
    assert not spec.has("sleeping")
    awake, asleep = (make_advance(each) for each in (spec, spec.including("sleeping")))
    assert identity(awake).digest != identity(asleep).digest
