"""Shares of effects in the balances of energy and momentum, by the log columns that they declare.

Which columns these are stands with each effect (`engine.effects.effect.Balance`); a log has the
columns of the effects that its run had.
"""

from __future__ import annotations

import numpy as np

from lavendersim.cell import CellConfig, Surface, changes_of_bodies
from lavendersim.cell.mixing import mixed
from lavendersim.engine.effects import EFFECTS
from lavendersim.measures.interfaces import Floats, Rows, Trace
from lavendersim.quantities.scalars import exact

PULLS = [effect.balance.pull for effect in EFFECTS if effect.balance.pull]
STORED = [effect.balance.stored for effect in EFFECTS if effect.balance.stored]
WORKING = [effect.balance.work for effect in EFFECTS if effect.balance.work]
OUTER = [effect.balance.outer for effect in EFFECTS if effect.balance.outer]
VARYING = [e.balance.varies_friction for e in EFFECTS if e.balance.varies_friction]


def varies_friction(surface: Surface) -> bool:
    """Whether the coefficient between two surfaces, mixed, changes with their motion."""
    return any(getattr(surface, key) > 0.0 for key in VARYING)


def surfaces_change(config: CellConfig) -> bool:
    """Whether an event changes the surface of a body: the log has then what contacts obeyed."""
    return any(event.surface is not None for event in changes_of_bodies(config.planned_events))


def _present(rows: Rows, names: list[str]) -> list[str]:
    columns = rows.dtype.names or ()
    return [name for name in names if name in columns]


def draws_together(contacts: Rows) -> bool:
    """Whether contacts have an impulse that draws their bodies together."""
    return bool(_present(contacts, PULLS))


def pull(contacts: Rows) -> Floats:
    """Return the impulse that draws the bodies of each contact together along n [N s] (n,)."""
    total = np.zeros(len(contacts))
    for name in _present(contacts, PULLS):
        total += contacts[name]
    return total


def net_impulse_n(contacts: Rows) -> Floats:
    """Return the normal impulse on B of each contact, less what draws together [N s] (n,)."""
    if not draws_together(contacts):
        pressing: Floats = contacts["impulse_n"]
        return pressing
    net: Floats = contacts["impulse_n"] - pull(contacts)
    return net


def given_by_pull(contacts: Rows) -> Floats:
    """Return the most that contacts gain by drawing their bodies together [J] (n,).

    Bodies that part lose to the pull, at a rate between those of the step's two ends: no gain.
    """
    if "normal_velocity" not in (contacts.dtype.names or ()):  # of an engine that draws nothing
        return np.zeros(len(contacts))
    gained: Floats = np.maximum(-pull(contacts) * contacts["normal_velocity"], 0.0)
    return gained


def stored(trace: Trace) -> Floats:
    """Return the energy that effects store in every logged state [J]."""
    total = np.zeros(len(trace.step))
    for name in _present(trace.step, STORED):
        total += trace.step[name]
    if "contact_energy" in _present(trace.step, STORED) and trace.step["step"][0] == 0:
        total[0] += stored_as_found(trace, 1)
    return total


def work(trace: Trace) -> Floats:
    """Return the work of effects from outside in each logged step [J] (n,); 0 of the first row."""
    total = np.zeros(len(trace.step))
    for name in _present(trace.step, WORKING):
        total[1:] += trace.step[name][1:]
    return total


def stored_as_found(trace: Trace, step: int) -> float:
    """Return what contacts store as a step begins [J]: of the first one no state before it has it.

    From where the step found them; what it meets on its way has no penetration.
    """
    if "/contacts" in trace.absent:
        return 0.0
    every = trace.contact
    first, last = (int(np.searchsorted(every["step"], step, side)) for side in ("left", "right"))
    surfaces = _surfaces_in(trace, step)
    found: dict[tuple[int, int, int], float] = {}
    between: dict[tuple[int, int], Surface] = {}
    for row in every[first:last]:
        pair, key = (row["body_a"], row["body_b"]), (row["body_a"], row["body_b"], row["feature"])
        if pair not in between:
            between[pair] = mixed(surfaces[pair[0]], surfaces[pair[1]])
        compliance, stiffness = between[pair].compliance, between[pair].hertz_stiffness
        depth = max(-float(row["separation"]), 0.0)
        if stiffness > 0.0:
            found.setdefault(key, 0.4 * stiffness * depth**2.5)
        elif compliance > 0.0:
            found.setdefault(key, 0.5 * depth * depth / compliance)
    return sum(found.values())


def _surfaces_in(trace: Trace, step: int) -> list[Surface]:
    """Return the surface of each body in a step, by its row."""
    bodies = {name: trace.config.scene.bodies[name].surface for name in trace.bodies}
    for event in changes_of_bodies(trace.events):
        if event.surface is not None and trace.clock.steps_until(exact(event.at)) < step:
            bodies[event.body] = event.surface
    return list(bodies.values())


def outer_impulse(trace: Trace) -> Floats:
    """Return the impulse on everything movable from what is not, beside contacts [N s] (n, 3)."""
    total = np.zeros((len(trace.step), 3))
    for names in OUTER:
        if _present(trace.step, list(names)):
            total += np.column_stack([trace.step[name] for name in names])
    return total
