"""Drawn scenes are the same to the bit in other units of length and time, as the constants are.

No number of the engine has a unit but those of `fuzz_constants.CONSTANTS`. Of a scene of another
size these decide otherwise: what touches, and what is too slow to count.
"""

from __future__ import annotations

import ast
import re
from pathlib import Path

import numpy as np
import pytest
from fuzz_constants import (
    CONSTANTS,
    Motion,
    difference,
    has_cavity,
    in_units,
    motions,
    plan_called,
)

import lavendersim.engine

ENGINE = Path(lavendersim.engine.__file__).parent
# Half of the scenes of the views, which have this engine, too; and as many in bowls and drums.
PLAN, SEED, ANY, CAVITIES = "0", 0, 12, 12
UNIT = re.compile(r"\[(m|s|m/s|rad/s|m\^2|m/s\^2|N|N s|kg|J)\b[^\]]*\]")
# What has none though a unit is said beside it, and what no scene has.
NO_UNITS = {
    "approach.NEVER": "infinity",
    "approach.ROUND_OFF": "a share; CREEP beside it is a speed",
    "collide.pairs.capsule_capsule.PARALLEL": "an angle",
    "collide.records.UNBOUNDED": "infinity",
    "collide.swept.ANY_MARGIN": "infinity",
    "error_estimate.NOISE": "a share; PLACE_NOISE beside it is a length",
    "compile_lock.LONGEST_WAIT": "of processes",
    "compile_lock._PAUSE": "of processes",
}


def is_number(value: ast.expr) -> bool:
    """Whether an expression is of numbers that are not counts, and of other constants."""
    if isinstance(value, ast.BinOp):
        return is_number(value.left) or is_number(value.right)
    if isinstance(value, ast.Tuple):
        return any(is_number(one) for one in value.elts)
    if isinstance(value, ast.Name):
        return value.id.isupper()
    return isinstance(value, ast.Constant) and isinstance(value.value, float)


def constants_with_units(path: Path) -> list[str]:
    """Return the names of a module's numbers whose comment, beside or above, has a unit."""
    text = path.read_text(encoding="utf-8")
    lines, found = text.splitlines(), []
    for node in ast.parse(text).body:
        if not isinstance(node, ast.Assign | ast.AnnAssign) or node.value is None:
            continue
        target = node.targets[0] if isinstance(node, ast.Assign) else node.target
        names = [n.id for n in ast.walk(target) if isinstance(n, ast.Name)]
        said, above = lines[node.lineno - 1].partition("#")[2], node.lineno - 2
        while above >= 0 and lines[above].startswith("#"):
            said, above = f"{lines[above]} {said}", above - 1
        if is_number(node.value) and UNIT.search(said):
            module = path.relative_to(ENGINE).with_suffix("").as_posix().replace("/", ".")
            found += [f"{module}.{name}" for name in names]
    return found


def test_constants_with_a_unit_are_known() -> None:
    found = [name for path in sorted(ENGINE.rglob("*.py")) for name in constants_with_units(path)]
    assert {*found} - {*NO_UNITS} == {*CONSTANTS}


def test_where_a_run_ends_is_compared_by_its_step_and_not_by_its_time() -> None:
    said = "diverged: body a turns too far after step {} (t = {} s)"
    one, same, later = (
        Motion(*[np.zeros(0)] * 3, said.format(*end), False)
        for end in ((11, "0.00341"), (11, "0.000852"), (12, "0.00341"))
    )
    assert difference(one, same) == ""
    assert "after step 12" in difference(one, later)


@pytest.mark.usefixtures("optimised")
def test_a_drawn_scene_is_the_same_in_other_units() -> None:
    plan = plan_called(PLAN, SEED)
    cavities = [n for n in range(ANY, 10 * CAVITIES) if has_cavity(plan, SEED, n)]
    numbers = [*range(ANY), *cavities[:CAVITIES]]
    plain, seen = motions(PLAN, SEED, numbers, None), in_units(PLAN, SEED, numbers)
    pairs = [
        pair for pair in zip(plain, seen, strict=True) if not (pair[0].rounds or pair[1].rounds)
    ]
    assert len(pairs) > 0.9 * len(numbers)
    assert [said for pair in pairs if (said := difference(*pair))] == []
