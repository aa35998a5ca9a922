"""The sums that a kernel takes while a cell runs are those that numpy takes of its log.

Two algorithms, one over the engine's rows in one pass and one column by column over the log's
table, of rows that are as wrong as a falsified log can be: equal to the last bit.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from lavendersim.measures.contact_sums import ContactSums, excesses, summed
from lavendersim.measures.sections import Section
from lavendersim.runner.contact_sums_kernel import COLUMNS, RunningSums
from tests.made_cells import made_cell

BODIES = ("floor", "ball", "crate", "belt")
STEPS = 400
PLAIN = [name for name in COLUMNS if "angular" not in name and "rolling" not in name]
FORMS = {
    "frictionless": [name for name in PLAIN if "_t" not in name and "friction" not in name],
    "friction": [name for name in PLAIN if not name.startswith("torsional")],
    "spins": list(COLUMNS),
    "adhesion": [*COLUMNS, "adhesive_impulse", "an_external_column"],
}


def section(names: list[str], cone: str, wrong: float, seed: int = 0) -> Section:
    """Return a log of random contacts, a share of whose numbers is out of all bounds."""
    random = np.random.default_rng(seed)
    counts = random.integers(0, 6, STEPS)
    counts[0] = 0
    integers = ("step", "body_a", "body_b")
    fields = [
        (name, "i8" if name in integers else "f8") for name in dict.fromkeys(("step", *names))
    ]
    rows = np.zeros(counts.sum(), fields)
    for name, kind in fields:
        if kind == "f8":
            numbers = random.normal(size=len(rows)) * 10.0 ** random.integers(-3, 3, len(rows))
            out = random.choice([np.nan, np.inf, -np.inf, 0.0, -0.0, 1e300, 5e-324], len(rows))
            rows[name] = np.where(random.random(len(rows)) < wrong, out, numbers)
    rows["step"] = np.repeat(np.arange(STEPS), counts)
    rows["body_a"], rows["body_b"] = random.integers(0, 4, (2, len(rows)))
    surface = {"friction": 0.4}
    sphere = {"shape": {"kind": "sphere", "radius": 0.1}, "mass": 1.0}
    slides = {"friction": 0.2, "static_friction": 0.3, "stribeck_velocity": 0.1}
    bodies: dict[str, Any] = {
        "floor": {"shape": {"kind": "plane"}, "surface": {"friction": 0.7}},
        "ball": {**sphere, "surface": surface},
        "crate": {**sphere, "surface": slides},
        "belt": {"shape": {"kind": "box", "size": [1, 1, 1]}, "surface": surface},
    }
    numerics = {"friction_cone": cone, "slop": 1e-3, "projection": 0.3}
    config = made_cell(bodies, numerics=numerics)
    step = np.zeros(STEPS, [("step", "i8")])
    step["step"] = np.arange(STEPS)
    pose = np.zeros((STEPS, len(BODIES), 7))
    return Section(step, rows, pose, BODIES, config, config.clock, {})


def by_kernel(part: Section) -> ContactSums:
    sums = RunningSums(part.config, list(part.bodies), part.clock)
    return sums(part.step, part.contact)


@pytest.mark.parametrize("cone", ["disc", "pyramid"])
@pytest.mark.parametrize("wrong", [0.0, 0.01, 0.3])
@pytest.mark.parametrize("form", FORMS)
def test_kernel_and_log_give_the_same_bits(form: str, wrong: float, cone: str) -> None:
    part = section(FORMS[form], cone, wrong)
    with np.errstate(all="ignore"):
        of_log = summed(part)
    for name, numbers in zip(ContactSums._fields, by_kernel(part), strict=True):
        np.testing.assert_array_equal(numbers, getattr(of_log, name), err_msg=name)


def test_sums_of_a_step_are_those_of_its_rows() -> None:
    """Row by row in plain Python, of one step at a time."""
    part = section(FORMS["spins"], "disc", 0.0)
    sums, contact = by_kernel(part), part.contact
    beyond = excesses(part, contact)
    for step in range(STEPS):
        mine = np.flatnonzero(contact["step"] == step)
        pushed = [abs(contact["impulse_n"][c]) for c in mine]
        worst = max([0.0, *(beyond[c] for c in mine)])
        assert sums.excess[step] == (worst / max(pushed) if worst else 0.0)
        assert sums.deepest[step] == max([0.0, *(contact["penetration"][c] for c in mine)])
        assert sums.not_finite[step] == 0.0
        # Five contacts of some ten operations: 50 round-offs of 1.1e-16 of their size, 6e-15.
        scale = 1e-14 * (sums.size[step] + 1e-300)
        for axis, total in zip("xyz", sums.outer[step], strict=True):
            expected = sum(_outer(contact[c], axis) for c in mine)
            assert abs(total - expected) <= scale


def _outer(row: Any, axis: str) -> float:
    """Return what a contact gives to everything movable along an axis; the floor is fixed."""
    movable = (0.0, 1.0, 1.0, 1.0)
    sign = movable[row["body_b"]] - movable[row["body_a"]]
    n, t1 = ([row[f"{name}{a}"] for a in "xyz"] for name in ("n", "t1"))
    k = "xyz".index(axis)
    t2 = n[(k + 1) % 3] * t1[(k + 2) % 3] - n[(k + 2) % 3] * t1[(k + 1) % 3]
    total = n[k] * row["impulse_n"] + t1[k] * row["impulse_t1"] + t2 * row["impulse_t2"]
    return float(sign * total)


@pytest.mark.parametrize(
    ("column", "number", "field"),
    [
        ("impulse_n", -3.0, "excess"),
        ("impulse_t1", 1e3, "excess"),
        ("angular_impulse_n", -1e3, "excess"),
        ("angular_impulse_t2", 1e3, "excess"),
        ("penetration", 7.0, "deepest"),
        ("nx", np.nan, "not_finite"),
    ],
)
def test_one_falsified_number_is_seen_in_its_step_alone(
    column: str, number: float, field: str
) -> None:
    part = section(FORMS["spins"], "disc", 0.0)
    # What keeps every limit: no impulse but a push.
    for name in ("impulse_t1", "impulse_t2", "angular_impulse_n", "angular_impulse_t1"):
        part.contact[name] = 0.0
    part.contact["angular_impulse_t2"], part.contact["penetration"] = 0.0, 0.0
    part.contact["impulse_n"] = 1.0
    for name in ("friction", "torsional_friction", "rolling_friction"):
        part.contact[name] = 0.01
    before = getattr(by_kernel(part), field).copy()
    assert not before.any()
    part.contact[column][7] = number
    changed = np.flatnonzero(getattr(by_kernel(part), field))
    assert changed.tolist() == [part.contact["step"][7]]
