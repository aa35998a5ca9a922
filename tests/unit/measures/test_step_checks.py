"""The checks of every step: their numbers by hand, their bodies, and bounds of a cell."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from synthetic import contacts, trace_of

from lavendersim.measures.specs.always import CHECKS, Always
from lavendersim.measures.step_checks import (
    NUMBERS,
    UNITS,
    CheckedSteps,
    StepChecks,
    bound_of,
    checks_of,
    contacts_of_row,
)

HEIGHTS = [1.0, 0.9, 0.7, 0.4, 0.0]
TOUCHING = [(3, 2.0, 0.002), (3, 4.0, 0.001), (4, 1.0, 0.03)]


def log() -> Any:
    one = trace_of(HEIGHTS, TOUCHING)
    step = np.zeros(len(one.step), [*one.step.dtype.descr, ("residual_contact", "i8")])
    for name in one.step.dtype.names:
        step[name] = one.step[name]
    step["residual"], step["residual_contact"] = [0.0, 0.0, 1e-9, 3e-5, 2e-6], [-1, -1, -1, 1, 0]
    one.step, one.absent = step, {}
    return one


def checked(check: str, trace: Any = None, **bounds: Any) -> CheckedSteps:
    always = Always.model_validate({"speed": 1.0, **bounds})
    return next(StepChecks(always, [check]).over(log() if trace is None else trace))


def test_every_check_has_numbers_and_a_unit() -> None:
    assert set(UNITS) == set(CHECKS) == {*NUMBERS, "energy"}


def test_a_speed_is_the_displacement_in_a_step_over_its_time() -> None:
    one = checked("speed")
    np.testing.assert_allclose(one.numbers, [0.0, 10.0, 20.0, 30.0, 40.0], rtol=1e-13)
    assert one.bodies(3) == "ball"
    assert one.bound == 1.0


def test_a_teleport_is_no_speed() -> None:
    trace = log()
    event = {"at": 0.02, "body": "ball", "teleport": [0.0, 0.0, 0.5]}
    trace.resolved["events"] = [event]
    assert checked("speed", trace).numbers[3] == 0.0  # the step that begins at 0.02 s
    assert checked("speed", trace).numbers[2] == pytest.approx(20.0)


def test_the_deepest_contact_of_a_step_names_its_pair() -> None:
    one = checked("penetration")
    assert one.numbers.tolist() == [0.0, 0.0, 0.0, 0.002, 0.03]
    assert one.bodies(3) == "floor and ball"
    assert one.bodies(1) == ""


def test_a_contact_that_pulls_shows_over_the_largest_of_its_step() -> None:
    trace = log()
    trace.contact = contacts([(3, 4.0, 0.0), (3, -0.5, 0.0)])
    numbers = checked("impulses", trace).numbers
    assert numbers[3] == pytest.approx(0.5 / 4.0)
    assert numbers[[0, 1, 2, 4]].tolist() == [0.0] * 4


def test_a_residual_is_that_of_the_step_and_names_its_contact() -> None:
    one = checked("residual")
    assert one.numbers.tolist() == [0.0, 0.0, 1e-9, 3e-5, 2e-6]
    assert (one.bodies(2), one.bodies(3)) == ("", "floor and ball")


def test_what_is_not_finite_is_counted_and_named() -> None:
    trace = log()
    trace.step["kinetic_energy"][2] = np.nan
    trace.pose[3, 1, 4] = np.inf
    trace.contact["force_n"][2] = np.nan  # of step 4
    one = checked("finite", trace)
    assert one.numbers.tolist() == [0.0, 0.0, 1.0, 1.0, 1.0]
    assert (one.bodies(2), one.bodies(3)) == ("", "ball")
    assert one.bound == 0.0


def test_a_derived_depth_is_a_tenth_of_the_thinnest_body() -> None:
    assert bound_of("penetration", Always(), log()) == pytest.approx(0.1 * 0.2)  # a ball of 0.1 m
    assert bound_of("penetration", Always(penetration=0.5), log()) == 0.5


def test_which_checks_a_config_asks_for() -> None:
    assert checks_of(None) == ()
    assert "speed" not in checks_of(Always())
    every = dict.fromkeys(("energy", "impulses", "momentum", "residual", "speed"), 1.0)
    assert checks_of(Always.model_validate({**every, "penetration": 1.0})) == CHECKS
    assert checks_of(Always(energy="none", impulses="none", penetration="none", momentum="none", residual="none")) == ("finite",)  # noqa: E501  # fmt: skip


def test_contacts_of_a_row_are_those_of_its_step() -> None:
    assert contacts_of_row(log(), 3)["impulse_n"].tolist() == [2.0, 4.0]
    assert len(contacts_of_row(log(), 2)) == 0
    without = log()
    without.absent = {"/contacts": "nothing can touch"}
    assert len(contacts_of_row(without, 3)) == 0
