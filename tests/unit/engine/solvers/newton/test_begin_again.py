"""What rounds left, begun again from inside: each impulse checked by Coulomb's law."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from drawn_contacts import stacked
from drawn_systems import COUNT, assert_coulombs_law, drawn_system, impulses
from interpreted import interpreted, records

from lavendersim.engine.records import PARAMETERS, dtype
from lavendersim.engine.solvers.newton import begin_again, inside_cones
from lavendersim.engine.solvers.newton.begin_again import FEWER_TURNS, NEAR, TURNS
from lavendersim.engine.solvers.newton.inside_cones import LONG_STEPS
from lavendersim.engine.spec import Spec

SPEC = Spec(effects=("friction", "newton", "rotation"), solver="adaptive")
# What makes a contact other than a cone, by the effects that bring it.
OTHERS = {
    ("compliance",): "gamma",
    ("rolling_friction",): "rolling",
    ("torsional_friction",): "torsional",
    ("contact_torque", "frictionless_contact", "joint"): "bilateral",
}
PARAMS = records(np.zeros(1, dtype(PARAMETERS)))[0]
ALL = [effect for effects in OTHERS for effect in effects]


@pytest.mark.parametrize("seed", [0, 1, 2, 3, 4, 5])
def test_rounds_from_there_end_at_coulombs_law(seed: int) -> None:
    """Of draws 0 and 4 too, where rounds from the impulses as drawn may jam."""
    drawn = drawn_system(SPEC, np.random.default_rng(seed))
    solve = interpreted(begin_again.make_begin_again(SPEC))
    solve(drawn.system, drawn.workspace, drawn.size, 400.0, (1e-11, 1e-9), PARAMS)
    assert_coulombs_law(drawn)


def test_contacts_without_friction_push_along_their_normals_alone(rng) -> None:
    mixed = SPEC.including("contact_torque", "frictionless_contact")
    drawn = drawn_system(mixed, rng)
    drawn.scene.contacts["frictional"][::2], drawn.scene.contacts["mu"][::2] = 0, 0.0
    before = drawn.scene.contacts.copy()
    for axis in "12":
        drawn.scene.contacts[f"lambda_{axis}"][::2] = 0.0
    lost = impulses(drawn.scene) - np.stack([before[f"lambda_{k}"] for k in "n12"], axis=1)
    moved = drawn.scene.inverse @ drawn.scene.jacobian.T @ lost.ravel()
    for row, change in zip(drawn.scene.velocities, moved.reshape(-1, 6), strict=True):
        for name, value in zip(("vx", "vy", "vz", "wx", "wy", "wz"), change, strict=True):
            row[name] += value
    solve = interpreted(begin_again.make_begin_again(mixed))
    solve(drawn.system, drawn.workspace, drawn.size, 400.0, (1e-11, 1e-9), PARAMS)
    assert (impulses(drawn.scene)[::2, 1:] == 0.0).all()
    assert_coulombs_law(drawn)


@pytest.mark.parametrize(("better", "near"), [(True, False), (False, False), (False, True)])
def test_what_is_no_better_is_taken_back(better: bool, near: bool, monkeypatch) -> None:
    """Of impulses by a script, twice as large or none, where 0 is what the law asks for.

    Where what is left is near what is enough, sweeps take more turns.
    """
    drawn = drawn_system(SPEC, np.random.default_rng(5))
    drawn.scene.contacts["target"] = 50.0  # all open
    before = impulses(drawn.scene)
    residual = interpreted(begin_again.make_residual(SPEC))
    left, _ = residual(drawn.system.contacts, drawn.system.count, drawn.system.velocities)
    enough = left / (0.5 * NEAR) if near else 1e-9
    set_impulse = interpreted(begin_again.make_set_impulse(SPEC))

    def scripted(system: Any, *_: Any) -> int:
        for contact, own in zip(system.contacts, before, strict=True):
            set_impulse(contact, system.velocities, *(own * (0.0 if better else 2.0)))
        return 7

    monkeypatch.setattr(begin_again, "make_from_inside", lambda spec: scripted)
    monkeypatch.setattr(begin_again, "make_alart_curnier", lambda spec: lambda *_: 0)
    sweeps: list[int] = []
    monkeypatch.setattr(begin_again, "make_sweep", lambda spec: lambda *_: sweeps.append(1))
    monkeypatch.setattr(begin_again, "SWEEPS", 3)
    solve = interpreted(begin_again.make_begin_again(SPEC))
    steps = solve(drawn.system, drawn.workspace, drawn.size, 400.0, (1e-11, enough), PARAMS)
    assert steps == (7 if better else 14)  # by each strategy
    turns = TURNS if near else FEWER_TURNS
    assert len(sweeps) == (0 if better else 3 * (2**turns - 1))
    expected = np.zeros((COUNT, 3)) if better else before
    # A sum of two impulses below 2 N s, and one of velocities.
    np.testing.assert_allclose(impulses(drawn.scene), expected, atol=1e-15)
    np.testing.assert_allclose(stacked(drawn.scene.velocities), drawn.motion, atol=1e-12)


@pytest.mark.parametrize("tried", [1e10, np.nan])
def test_impulses_that_are_taken_back_leave_no_digit_behind(tried: float, monkeypatch) -> None:
    """Impulses of so many newton seconds, by a script: 1e-16 of them is 1e-6 m/s here."""
    drawn = drawn_system(SPEC, np.random.default_rng(5))
    before, velocities = impulses(drawn.scene), stacked(drawn.scene.velocities)
    set_impulse = interpreted(begin_again.make_set_impulse(SPEC))

    def scripted(system: Any, *_: Any) -> int:
        for contact in system.contacts:
            set_impulse(contact, system.velocities, tried, 0.1 * tried, -0.1 * tried)
        return 1

    monkeypatch.setattr(begin_again, "make_from_inside", lambda _: scripted)
    monkeypatch.setattr(begin_again, "make_alart_curnier", lambda _: lambda *_: 0)
    monkeypatch.setattr(begin_again, "make_sweep", lambda _: lambda *_: 0.0)
    monkeypatch.setattr(begin_again, "SWEEPS", 1)
    solve = interpreted(begin_again.make_begin_again(SPEC))
    solve(drawn.system, drawn.workspace, drawn.size, 400.0, (1e-11, 1e-9), PARAMS)
    np.testing.assert_array_equal(impulses(drawn.scene), before)
    np.testing.assert_array_equal(stacked(drawn.scene.velocities), velocities)


def test_sweeps_go_on_where_nothing_from_inside_ends(monkeypatch) -> None:
    """By themselves to Coulomb's law, in as many as they take here; rounds would need a few."""
    drawn = drawn_system(SPEC, np.random.default_rng(5))
    monkeypatch.setattr(begin_again, "make_from_inside", lambda spec: lambda *_: 0)
    monkeypatch.setattr(begin_again, "make_alart_curnier", lambda spec: lambda *_: 0)
    system = drawn.system._replace(order=np.arange(COUNT))
    solve = interpreted(begin_again.make_begin_again(SPEC))
    assert solve(system, drawn.workspace, drawn.size, 400.0, (1e-11, 1e-9), PARAMS) == 0
    assert_coulombs_law(drawn)


def test_what_is_solved_is_left_alone(rng) -> None:
    drawn = drawn_system(SPEC, rng)
    before = drawn.scene.contacts.copy()
    solve = interpreted(begin_again.make_begin_again(SPEC))
    assert solve(drawn.system, drawn.workspace, drawn.size, 400.0, (1e-11, 1e3), PARAMS) == 0
    assert (drawn.scene.contacts == before).all()


@pytest.mark.parametrize(("effects", "name"), OTHERS.items())
def test_a_contact_that_is_no_cone_is_left_to_others(
    effects: tuple[str, ...], name: str, rng
) -> None:
    """And what an engine has beside its contacts changes no bit of what it does with cones."""
    spec = SPEC.including(*effects)
    drawn = drawn_system(spec, rng)
    drawn.scene.contacts[name] = 0
    are_cones = interpreted(begin_again.make_are_cones(spec))
    assert are_cones(drawn.system.contacts, COUNT)
    drawn.scene.contacts[name][-1] = 1
    assert not are_cones(drawn.system.contacts, COUNT)
    before = drawn.scene.contacts.copy()
    solve = interpreted(begin_again.make_begin_again(spec))
    assert solve(drawn.system, drawn.workspace, drawn.size, 400.0, (1e-11, 1e-9), PARAMS) == 0
    assert (drawn.scene.contacts == before).all()


def test_engines_that_know_more_than_cones_find_the_same_bits() -> None:
    found = []
    for spec in (SPEC, SPEC.including(*ALL)):
        drawn = drawn_system(SPEC, np.random.default_rng(1))
        wide = drawn_system(spec, np.random.default_rng(1))
        for name in drawn.scene.contacts.dtype.names:
            wide.scene.contacts[name] = drawn.scene.contacts[name]
        for name in OTHERS.values():
            if name in wide.scene.contacts.dtype.names:
                wide.scene.contacts[name] = 0
        for name in drawn.scene.velocities.dtype.names:
            wide.scene.velocities[name] = drawn.scene.velocities[name]
        solve = interpreted(inside_cones.make_from_inside(spec))
        solve(wide.system, wide.workspace, wide.size, 30.0, LONG_STEPS, 1e-9)
        found.append(impulses(wide.scene))
    np.testing.assert_array_equal(*found)


def test_without_friction_there_is_none_of_it() -> None:
    smooth = Spec(effects=("contact_torque", "newton", "rotation"), solver="adaptive")
    assert begin_again.make_begin_again(smooth) is None
