"""Rows of bodies that jump are those of the start, and of nothing else."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest

from lavendersim.engine.midpoint_jumps import make_carry_along
from lavendersim.engine.record_layout import contact_dtype
from lavendersim.engine.records import DIVERGED, MOTION, dtype
from lavendersim.engine.spec import Spec
from lavendersim.experiment import load_experiment_text
from lavendersim.scene.build import build
from lavendersim.scene.plan import plan_of_cell
from tests.families_of_plans import spec_of_family

SPEC = Spec(effects=("contact_midpoint", "friction", "impact_order", "impact_time", "rotation"))
FLOOR = 0  # has no mass; bodies 1 to 3 have


class Row(NamedTuple):
    """A contact that was solved."""

    a: int
    b: int
    pushes: bool
    lasts: bool


def jumping(rows: list[Row]) -> tuple[bool, list[int]]:
    """Return whether a pass more is needed, and what the rows are then."""
    contacts, motion = np.zeros(len(rows), contact_dtype(SPEC)), np.zeros(4, dtype(MOTION))
    for contact, row in zip(contacts, rows, strict=True):
        contact["a"], contact["b"] = row.a, row.b
        contact["lambda_n"], contact["lasts"] = float(row.pushes), int(row.lasts)
        contact["inv_m_a"], contact["inv_m_b"] = float(row.a != FLOOR), float(row.b != FLOOR)
    more = make_carry_along(SPEC)(contacts, len(rows), motion)
    return bool(more), [int(jumps) for jumps in contacts["jumps"]]


LASTS = Row(FLOOR, 1, pushes=True, lasts=True)


@pytest.mark.parametrize("pushes", [False, True])
def test_what_lasts_alone_has_a_middle(pushes: bool) -> None:
    assert jumping([LASTS, Row(FLOOR, 1, pushes, lasts=True)]) == (False, [0, 0])


@pytest.mark.parametrize("pushes", [False, True])
def test_a_push_that_does_not_last_takes_the_middle_from_the_rows_of_its_body(pushes: bool) -> None:
    """As long as it pushes: a contact that is passed by makes nothing jump."""
    jumps = int(pushes)
    assert jumping([LASTS, Row(FLOOR, 1, pushes, lasts=False)]) == (pushes, [jumps, 0])


def test_a_body_that_is_pushed_by_one_that_jumps_jumps_with_it() -> None:
    """1 jumps and pushes 2, whose floor is one more; 3 stands apart, and on the same floor."""
    chain = [
        Row(FLOOR, 2, pushes=True, lasts=True),
        Row(1, 2, pushes=True, lasts=True),
        Row(FLOOR, 1, pushes=True, lasts=False),
        Row(FLOOR, 3, pushes=True, lasts=True),
    ]
    assert jumping(chain) == (True, [1, 1, 0, 0])
    passed_by = [chain[0], chain[1]._replace(pushes=False), *chain[2:]]
    assert jumping(passed_by) == (True, [0, 1, 0, 0])


def test_rows_that_have_lost_their_middle_ask_for_no_pass_more() -> None:
    assert jumping([LASTS._replace(lasts=False), Row(FLOOR, 1, True, lasts=False)])[0] is False


PLATE = """
question: Does a plate that wobbles win energy?
scene:
  surfaces: {{metal: {{friction: {friction}}}}}
  bodies:
    floor: {{shape: {{kind: plane}}, surface: metal}}
    plate:
      shape: {{kind: cylinder, radius: 0.1, length: {length}}}
      mass: 0.3
      surface: metal
      orientation: {{axis: [1, 0, 0], degrees: {degrees}}}
      angular_velocity: {spin}
      release: {{above: floor, clearance: 0.003, phase: 0}}
numerics: {{projection: 0}}
duration: 0.4
"""
# m/s: what a solve and the fixed point of the middle may each leave, at both ends of a step.
LEFT = 4e-9


@pytest.mark.parametrize(
    ("length", "degrees", "spin", "friction"),
    [
        (0.01, 3, "[0, 0, 3]", 0.3),
        (0.005, 3, "[5, 0, 5]", 0.3),
        (0.005, 20, "[0, 0, 3]", 0.1),
        (0.01, 12, "[5, 0, 5]", 0.3),
    ],
)
def test_a_plate_that_lands_on_its_rim_wins_no_energy(
    length: float, degrees: int, spin: str, friction: float
) -> None:
    """Plastic, and nothing lifts it: no step creates more than what a solve leaves times its
    impulses. Some points of the rim last while others land.
    """
    text = PLATE.format(length=length, degrees=degrees, spin=spin, friction=friction)
    cell = load_experiment_text(text, "plate.yaml").cells()[0]
    spec = spec_of_family(plan_of_cell(cell))
    engine = build(cell.config, spec).engine(spec)
    engine.advance(0)
    (before,) = engine.take_rows().step
    energy = before["kinetic_energy"] + before["potential_energy"]
    won = []
    while engine.counters["step"][0] < cell.config.steps:
        assert engine.advance(1) != DIVERGED
        rows = engine.take_rows()
        for after in rows.step:  # one, but where a call ends for want of room
            now = after["kinetic_energy"] + after["potential_energy"]
            if after["not_converged"] == 0:
                impulses = float(rows.contact["impulse_n"].sum())
                won.append(now - energy - LEFT * impulses - 1e-14 * energy)
            energy = now
    assert len(won) > 90  # of 96
    assert max(won) <= 0.0
