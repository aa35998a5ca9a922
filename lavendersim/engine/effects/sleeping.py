"""Sleeping: islands of bodies that have come to rest are left out until something disturbs them.

A body is at rest in a step that it begins no faster than `sleep_speed`, by the speed of its points
    point_speed = |v| + |omega| R,     R radius about the centre of mass that holds the body.
An island (`islands`) falls asleep as a whole, when each of its bodies has been at rest for
`sleep_time`, no force from the config acts on it, no spring joins it to another body and no
kinematic body that moves touches it.
Asleep, a body is as a fixed one: its inverse mass is kept aside and reads 0, so that nothing
accelerates, pushes or moves it. Contacts between bodies that cannot move are not made, solved or
logged; the island begins cold when it wakes, as a whole: when a body faster than `sleep_speed` or a
moving kinematic one makes a contact with it, a force acts on it, or an event changes one of its
bodies, or gravity. Nothing else can take its supports away: they are asleep with it, or fixed.
"""

from __future__ import annotations

from math import sqrt
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np

from ..spec import Spec
from ..step_terms import step_terms
from .decision import Decision, Facts, named
from .effect import Column, Effect, Fields, Hooks, kernel


def decide(facts: Facts) -> Decision:
    """On when the numerics ask for it and something can come to rest."""
    if not facts.sleeping:
        return Decision(False, "sleeping is false")
    movable = [body.name for body in facts.bodies if body.movable]
    if movable:
        return Decision(True, f"sleeping is true: {named(movable)} may come to rest")
    return Decision(False, "sleeping is true, but nothing can come to rest")


def make_still(spec: Spec) -> Any:
    """Return `kernel(body) -> whether it cannot move in this step`."""
    kinematic = step_terms(spec).kinematic

    def still(body):
        if kinematic:
            if body.kinematic == 1:
                return body.point_speed == 0.0
        return body.inv_m == 0.0

    return kernel(still, spec)


def make_measure_speeds(spec: Spec) -> Any:
    """Return `kernel(bodies, velocities)`: `point_speed` of every body, before forces act."""
    turns = step_terms(spec).turns

    def measure_speeds(bodies, velocities):
        for i in range(bodies.shape[0]):
            body, v = bodies[i], velocities[i]
            body.point_speed = sqrt(v.vx * v.vx + v.vy * v.vy + v.vz * v.vz)
            if turns:
                body.point_speed += body.bound * sqrt(v.wx * v.wx + v.wy * v.wy + v.wz * v.wz)

    return kernel(measure_speeds, spec)


def make_is_pushed(spec: Spec) -> Any:
    """Return `kernel(body) -> whether a force of the config acts on it, or a spring joins it`."""
    from . import effects_of, made_by

    joins = any(effect.links for effect in effects_of(spec))

    def is_joined(body):
        joined = False
        if joins:
            joined = body.joined == 1
        return joined

    pushed = kernel(is_joined, spec)
    for pushes in made_by(spec, "pushes"):
        pushed = _either(pushes, pushed, spec)
    return pushed


def _either(one: Any, other: Any, spec: Spec) -> Any:
    def is_pushed(body):
        return one(body) or other(body)

    return kernel(is_pushed, spec)


def make_wake_island(spec: Spec) -> Any:
    """Return `kernel(bodies, island)`: every body of an island gets its mass back."""
    turns = step_terms(spec).turns

    def wake_island(bodies, island):
        for i in range(bodies.shape[0]):
            body = bodies[i]
            if body.asleep == 1 and body.island == island:
                body.asleep, body.rest = 0, 0.0
                body.inv_m = body.own_inv_m
                if turns:
                    body.inv_ix, body.inv_iy = body.own_inv_ix, body.own_inv_iy
                    body.inv_iz = body.own_inv_iz

    return kernel(wake_island, spec)


def wake_around(bodies: np.ndarray, row: int) -> None:
    """Wake the island of one row, between steps. Of a kinematic one, all: who leaned on it?"""
    chosen = bodies["asleep"] == 1
    if chosen[row]:
        chosen &= bodies["island"] == bodies["island"][row]
    elif bodies["inv_m"][row] > 0.0:
        chosen[:] = False
    wake_rows(bodies, chosen)


def wake_rows(bodies: np.ndarray, chosen: np.ndarray) -> None:
    """Give sleeping rows their masses back, between steps; chosen: (bodies,) bool.

    Nobody has rested since what changed: who was about to fall asleep would do so in the next step,
    which it begins at rest, and hang in the air where its support is gone.
    """
    bodies["asleep"][chosen], bodies["rest"] = 0, 0.0
    for name in ("inv_m", "inv_ix", "inv_iy", "inv_iz"):
        if name in (bodies.dtype.names or ()):
            bodies[name][chosen] = bodies[f"own_{name}"][chosen]


def make_wake(spec: Spec) -> Any:
    """Return `kernel(bodies, contacts, count, params) -> whether anyone woke`.

    Who wakes has contacts that were not made: the step then begins again.
    """
    kinematic = step_terms(spec).kinematic
    wake_island, is_pushed = make_wake_island(spec), make_is_pushed(spec)

    def disturbs(other, params):
        if kinematic:
            if other.kinematic == 1:
                return other.point_speed > 0.0
        return other.asleep == 0 and other.point_speed > params.sleep_speed

    disturbs = kernel(disturbs, spec)

    def wake(bodies, contacts, count, params):
        woken = False
        for i in range(bodies.shape[0]):
            if bodies[i].asleep == 1:
                # An event may have given it a velocity.
                if bodies[i].point_speed > 0.0 or is_pushed(bodies[i]):
                    wake_island(bodies, bodies[i].island)
                    woken = True
        for c in range(count):
            contact = contacts[c]
            a, b = bodies[contact.a], bodies[contact.b]
            if a.asleep == 1 and disturbs(b, params):
                wake_island(bodies, a.island)
                woken = True
            elif b.asleep == 1 and disturbs(a, params):
                wake_island(bodies, b.island)
                woken = True
        return woken

    return kernel(wake, spec)


def make_update_sleeping(spec: Spec) -> Any:
    """Return `kernel(state, count, island, params)`; state: see `memory`.

    At the end of a step: who has been at rest for how long, and which islands fall asleep.
    `point_speed` is that of the step's begin: what counts is a step behind. island: (bodies,)
    int64, overwritten.
    """
    from ..integrate import keeps_motion
    from ..islands import make_label_islands

    turns, keeps = step_terms(spec).turns, keeps_motion(spec)
    kinematic = step_terms(spec).kinematic
    label_islands, is_pushed = make_label_islands(spec), make_is_pushed(spec)

    def put_to_sleep(body, v, label):
        body.asleep, body.island = 1, label
        body.own_inv_m, body.inv_m = body.inv_m, 0.0
        v.vx, v.vy, v.vz = 0.0, 0.0, 0.0
        if turns:
            body.own_inv_ix, body.own_inv_iy = body.inv_ix, body.inv_iy
            body.own_inv_iz = body.inv_iz
            body.inv_ix, body.inv_iy, body.inv_iz = 0.0, 0.0, 0.0
            v.wx, v.wy, v.wz = 0.0, 0.0, 0.0

    put_to_sleep = kernel(put_to_sleep, spec)

    def join(bodies, one, other):
        # Islands that lean on each other wake together.
        least, rest = min(one, other), max(one, other)
        for i in range(bodies.shape[0]):
            if bodies[i].asleep == 1 and bodies[i].island == rest:
                bodies[i].island = least

    join = kernel(join, spec)

    def update_sleeping(state, count, island, params):
        bodies, velocities, motion = state.bodies, state.velocities, state.motion
        contacts = state.contacts
        restful = False
        for i in range(bodies.shape[0]):
            body = bodies[i]
            if body.inv_m > 0.0:
                # In this order a NaN is no rest.
                if body.point_speed <= params.sleep_speed and not is_pushed(body):
                    body.rest += params.dt
                else:
                    body.rest = 0.0
                restful = restful or body.rest >= params.sleep_time
        if kinematic:
            for c in range(count):
                a, b = bodies[contacts[c].a], bodies[contacts[c].b]
                if a.kinematic == 1 and a.point_speed > 0.0:
                    b.rest = 0.0
                if b.kinematic == 1 and b.point_speed > 0.0:
                    a.rest = 0.0
        if not restful:
            return
        label_islands(contacts, count, bodies, island)
        # The rest of an island is that of its latest body; its label's body gathers it.
        for i in range(bodies.shape[0]):
            if island[i] >= 0:
                first = bodies[island[i]]
                first.rest = min(first.rest, bodies[i].rest)
        slept = False
        for i in range(bodies.shape[0]):
            if island[i] >= 0 and bodies[island[i]].rest >= params.sleep_time:
                put_to_sleep(bodies[i], velocities[i], island[i])
                slept = True
                if keeps:
                    motion[i].dvx, motion[i].dvy, motion[i].dvz = 0.0, 0.0, 0.0
        if slept:
            for c in range(count):
                a, b = bodies[contacts[c].a], bodies[contacts[c].b]
                if a.asleep == 1 and b.asleep == 1 and a.island != b.island:
                    join(bodies, a.island, b.island)

    return kernel(update_sleeping, spec)


def make_step_row(spec: Spec) -> Any:
    """Return `kernel(row, bodies, counters)` that fills its columns of a step."""

    def log_awake(row, bodies, counters):
        row.awake = 0
        for i in range(bodies.shape[0]):
            if bodies[i].inv_m > 0.0:
                row.awake += 1

    return kernel(log_awake, spec)


EFFECT = Effect(
    name="sleeping",
    decide=decide,
    per="body",
    fields=Fields(
        body=[
            ("asleep", "i8"),  # 1: at rest, left out
            ("island", "i8"),  # asleep: the number its island has in common
            ("point_speed", "f8"),  # of its fastest point, at most, as the step begins [m/s]
            ("rest", "f8"),  # how long it has been at rest [s]
            ("own_inv_m", "f8"),  # asleep: its inverse mass once awake [1/kg], and inertia
            ("own_inv_ix", "f8"),
            ("own_inv_iy", "f8"),
            ("own_inv_iz", "f8"),
        ],
    ),
    step_columns=(Column("awake", "i8", "number of movable bodies that do not sleep", number=20),),
    hooks=Hooks(
        measure_speeds=make_measure_speeds,
        is_still=make_still,
        wake=make_wake,
        update_sleeping=make_update_sleeping,
        step_row=make_step_row,
    ),
)
