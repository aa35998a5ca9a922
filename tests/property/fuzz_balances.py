"""What each step of any run must balance, by the states before and after it and its contacts.

momentum     m (v_1 - v_0) = (m g + F) dt + sum of impulses, of each body that no drag, no spring
             and no varying force pulls: friction, restitution, cohesion and every solver included;
             where a step says that springs were not found, of none that contacts join to one
penetration  grows in a step by no more than two bodies can move in it, as depth is 1-Lipschitz in
             where bodies stand: |d(x) - d(y)| <= |x - y|; not of stops of joints, whose arm is as
             long as their axis is far, and which a turn by more than half a circle passes by; of
             meshes up to what a body reaches, for one whose centre is behind a face touches nothing
gap          what pushes touches, or comes to touch by what the two bodies move in the step, or
             would without contacts (Signorini); but for a push as small as the row's residual
energy       does not grow but by what a step's residual and its first order in time leave, where
             nothing but weight gives any (`is_calm`)

A body that a step leaves asleep is out of the first and the third: it loses what speed it has
left. An event that moves a body or takes one away, and a body that wakes in others, begin the
second anew.
"""

from __future__ import annotations

import numpy as np
from fuzz_gaps import END, deeper_than_moved, is_anew, pushes_across_gaps
from fuzz_steps import Steps, Tables, gained_by_contacts, impulses_of, pulled, steps_of

from lavendersim.cell import CellConfig
from lavendersim.engine.effects.joint_models import Joint
from lavendersim.engine.engine import Rows

# Impulses add up from thousands of updates, each rounded by 1e-16 of what it is; on their way they
# may be a thousand times what they end with.
ROUND_OFF = 1e-9
# So may a row that ends with none be as large as any other of its step, in some updates; or as
# those of the step before, with which a warm start begins.
TAKEN_BACK = 64.0 * np.finfo(float).eps


def unbalanced(
    config: CellConfig, rows: Rows, states: list[tuple[Tables, Tables]], whole: int
) -> tuple[list[str], list[str]]:
    """Return every balance that a run breaks, and the laws that it was judged by.

    whole: how many of its steps are finite.
    """
    if whole < 1:
        return [], []
    steps = steps_of(config, rows, states, whole)
    found, judged = (
        _momentum(config, rows, steps) + pushes_across_gaps(config, steps),
        ["momentum", "gap"],
    )
    if is_calm(config):
        found, judged = found + _energy(config, rows, steps), [*judged, "energy"]
    if not is_anew(config, steps):
        found, judged = found + deeper_than_moved(config, rows, steps), [*judged, "penetration"]
    return found, judged


def _placed(config: CellConfig, rows: Rows, steps: Steps) -> np.ndarray:
    """Return (k, n) which bodies a step may have placed where springs were not found.

    Such a step says so, and takes velocities from its union (`engine/spring_contacts.py`): bodies
    that contacts join to one with a spring.
    """
    names = [*config.scene.bodies]
    sprung = {names.index(name) for one in config.scene.springs for name in (one.a, one.b)}
    placed = np.zeros(steps.before.mass.shape, dtype=bool)
    # Plans without contacts at the middle have no unions: their springs act on free bodies.
    if not sprung or "spring_not_converged" not in (rows.step.dtype.names or ()):
        return placed
    missed = rows.step["spring_not_converged"][1 : len(placed) + 1] > 0
    for step in np.flatnonzero(missed):
        own = steps.contact[steps.at == step]
        union = set(sprung)
        while True:
            beside = {int(k) for a, b in zip(own["body_a"], own["body_b"], strict=True)
                      if a in union or b in union for k in (a, b)}  # fmt: skip
            if beside <= union:
                break
            union |= beside
        placed[step, [*union]] = True
    return placed


def _momentum(config: CellConfig, rows: Rows, steps: Steps) -> list[str]:
    before, after, contact = steps.before, steps.after, steps.contact
    push, gained, size = (
        impulses_of(contact),
        gained_by_contacts(steps),
        np.zeros(before.mass.shape),
    )
    # What cohesion takes back of a push is as large on its way.
    sizes = np.abs(push).sum(axis=1) + np.abs(contact["impulse_n"])
    for column in ("body_a", "body_b"):
        np.add.at(size, (steps.at, contact[column]), sizes)
    weight = before.mass[..., None] * before.gravity[:, None] + before.force
    weight *= before.dt[:, None, None]
    change = before.mass[..., None] * (after.velocity - before.velocity)
    size += np.abs(weight).sum(axis=2)
    size += before.mass * (np.abs(after.velocity) + np.abs(before.velocity)).sum(axis=2)
    free = (before.mass > 0.0) & (before.asleep == 0) & (after.asleep == 0)
    free &= ~np.array(pulled(config)) & ~_placed(config, rows, steps)
    miss = np.linalg.norm(change - weight - gained, axis=2)
    largest = np.zeros(len(before.dt))
    np.maximum.at(largest, steps.at, sizes)
    if config.numerics.warm_start:
        largest[1:] = np.maximum(largest[1:], largest[:-1])
    wrong = free & ~(miss <= ROUND_OFF * size + TAKEN_BACK * largest[:, None])
    if not wrong.any():
        return []
    step = int(np.argmax(wrong.any(axis=1)))
    k = int(np.argmax(np.where(wrong[step], miss[step] / size[step], 0.0)))
    said = f"{miss[step, k]:.3g} of {size[step, k]:.3g} N s in step {step + 1}"
    return [f"momentum: {[*config.scene.bodies][k]} is off by {said}"]


def is_calm(config: CellConfig) -> bool:
    """Whether nothing but weight can give energy to the bodies of a scene."""
    scene, numerics = config.scene, config.numerics
    if scene.forces or scene.springs or config.events or config.triggered:
        return False
    if numerics.stabilisation_gain > 0.0 or numerics.projection > 0.0:
        return False
    for one in scene.connections.values():
        # What steps that are not centred leave of joints is projected back, at whatever height.
        joined = isinstance(one, Joint) and numerics.integrator != "midpoint_contact"
        if joined or getattr(one, "motor", None) or getattr(one, "restitution", 0.0) > 0.0:
            return False
    return not any(
        body.kinematic
        or any(body.surface_velocity)
        or body.surface.cohesion > 0.0
        or body.surface.compliance > 0.0
        or body.surface.restitution > 0.0
        or body.surface.tangential_restitution > 0.0
        for body in scene.bodies.values()
    )


def _energy(config: CellConfig, rows: Rows, steps: Steps) -> list[str]:
    """A row that misses its law by r [m/s] gives at most r times its impulse, or its momentum.

    What contacts carry falls another way than by the mean of its velocities, by up to
    |dv| dt + g dt^2/2; see `tests/property/test_zoo_energy.py`.
    """
    before, after = steps.before, steps.after
    count = len(before.dt)
    pull = float(np.linalg.norm(config.scene.gravity))
    kinetic = rows.step["kinetic_energy"][: count + 1]
    potential = rows.step["potential_energy"][: count + 1]
    flown = np.linalg.norm(before.velocity, axis=2) + np.linalg.norm(after.velocity, axis=2)
    turned = np.linalg.norm(before.spin, axis=2) + np.linalg.norm(after.spin, axis=2)
    momenta = (before.mass * (flown + before.bound * turned)).sum(axis=1)
    size = np.abs(impulses_of(steps.contact)).sum(axis=1)
    pushes = np.bincount(steps.at, weights=size, minlength=count)
    jumps = np.linalg.norm(after.velocity - before.velocity, axis=2)
    way = before.dt[:, None] * (jumps + pull * before.dt[:, None])
    allowed = rows.step["residual"][1 : count + 1] * (pushes + momenta)
    allowed += pull * (before.mass * way).sum(axis=1) + _brought_together(steps, pull)
    at_play = kinetic[:-1] + np.abs(potential[1:]) + np.abs(potential[:-1])
    gained = np.diff(kinetic + potential)
    wrong = gained > allowed + ROUND_OFF * at_play
    if not wrong.any():
        return []
    k = int(np.argmax(wrong))
    said = f"{gained[k]:.3g} J in step {k + 1}, of at most {allowed[k]:.3g} J"
    return [f"energy: gained {said}; {kinetic[k]:.3g} J before"]


def _brought_together(steps: Steps, pull: float) -> np.ndarray:
    """Return what a step may give or take as it brings ends of joints together (k,) [J].

    By s they move a body by up to END s, at whatever height, and turn it by END s of its size: with
    the spin that it keeps it has another energy, by less than m bound w^2 for each metre.
    """
    before, contact = steps.before, steps.contact
    given = np.zeros(len(before.dt))
    if "joint" not in (contact.dtype.names or ()):
        return given
    spin = np.linalg.norm(before.spin, axis=2)
    by_metre = END * before.mass * (pull + before.bound * spin * spin)
    apart = np.where(contact["joint"] > 0, np.abs(contact["separation"]), 0.0)
    for column in ("body_a", "body_b"):
        np.add.at(given, steps.at, apart * by_metre[steps.at, contact[column]])
    return given
