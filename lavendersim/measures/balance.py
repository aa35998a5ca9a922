"""Balances of energy and momentum: what of each step neither forces nor impulses explain.

Energy. Let a step take velocities v' to v = v' + (g + F/m) dt + j/m and places by v dt. With the
potential -m g . x and the work F . v dt of the forces of the config, the energy it creates is
    v . j - m |v - v'|^2 / 2,  summed over bodies,
and sum v . j = sum over contacts w . lambda, w their relative velocities after the solve. That is 0
along a normal that neither rebounds nor is pushed by stabilisation (complementarity), below 0 under
friction: no step creates energy. A body in free flight moves by the mean of v' and v (`midpoint`),
which conserves it exactly; one that rebounds at the surface with e <= 1 loses (1 - e^2) of what it
brings; compliance takes energy. What can create some without being wrong is the projection, which
lifts what sank: at most M |g| times the sum over contacts of what it opens,
    projection * max(d - v_n dt - slop, 0),   d the penetration, v_n after the solve.
So energy less work, less what events and the projection gave, never rises. What it rises above its
lowest value so far is counted, relative to what is at play: the first kinetic energy, the weight of
each body times its radius, what the potential energy has fallen by, the work of the forces and what
events gave, so far.

A step solved to the residual r creates at most r times the sum of its impulses: at 1e-9 m/s a ball
of 0.1 m at rest needs 100 s to reach 1e-6 of its weight times its radius, at the worst.
A gain (`stabilisation_gain`) turns penetration into velocity and does create energy; restitution
captured at the start of a step (`impacts: captured`) creates up to m |g| dt times the speed, since
the body moves off from where it began the step; a gain together with compliance stores energy and
gives it back. All are counted.

Momentum. p - p' = M g dt + sum F dt + J, J the impulses between movable and other bodies, friction
included; impulses between movable bodies cancel. All of it is exact but for round-off: every
impulse is added to two velocities in each sweep, so a thousand roundings of 1e-16 of what enters.
It is counted relative to that: the impulses of all contacts, M |g| dt, |F| dt, and sqrt(2 M E_k),
which no sum m |v| exceeds (Cauchy and Schwarz), before and after the step.
"""

from __future__ import annotations

import math

import numpy as np

from lavendersim.cell import changes_of_gravity
from lavendersim.geometry.bodies import is_movable, mass_of, vector
from lavendersim.geometry.shapes import bounding_radius
from lavendersim.measures import changes, shares
from lavendersim.measures.contact_sums import ContactSums
from lavendersim.measures.interfaces import Floats, Trace
from lavendersim.measures.step_passes import (
    FIRST_KINETIC,
    FIRST_POTENTIAL,
    LOWEST,
    LOWEST_POTENTIAL,
    OVER_LOGS,
    OWN_WEIGHT,
    SO_FAR,
    EnergyRows,
    MomentumRows,
    Passes,
)


class EnergyBalance:
    """The energy a run has gained, state by state; a log may come in several sections."""

    def __init__(self, passes: Passes = OVER_LOGS) -> None:
        self._passes = passes
        self._so_far: Floats | None = None

    def created(self, trace: Trace, sums: ContactSums) -> Floats:
        """Return, in every state, the energy gained since it was lowest over that at play [-].

        trace: a log, or its next section: the last state that was counted, without its
        contacts, and what follows.
        """
        step, stored = trace.step, shares.stored(trace)
        if self._so_far is None:
            self._so_far = so_far = np.zeros(SO_FAR)
            so_far[LOWEST] = math.inf
            so_far[[LOWEST_POTENTIAL, FIRST_POTENTIAL]] = step["potential_energy"][0] + stored[0]
            so_far[FIRST_KINETIC] = step["kinetic_energy"][0]
            so_far[OWN_WEIGHT] = _own_weight(trace)
        rows = EnergyRows(
            kinetic=step["kinetic_energy"],
            potential=step["potential_energy"],
            stored=stored,
            work=changes.work_of_forces(trace) + shares.work(trace),
            events=changes.given_by_events(trace),
            lifted=_lifted(trace, sums),
            pulled=sums.pulled,
        )
        return self._passes.created(rows, self._so_far)


def momentum_imbalance(trace: Trace, sums: ContactSums, passes: Passes = OVER_LOGS) -> Floats:
    """Return the part of each step's change of momentum without a cause, over all causes [-]."""
    step = trace.step
    rows = MomentumRows(
        momentum=(step["momentum_x"], step["momentum_y"], step["momentum_z"]),
        kinetic=step["kinetic_energy"],
        mass=changes.masses(trace),
        gravity=vector(trace.config.scene.gravity),
        forces=changes.forces(trace),
        others=shares.outer_impulse(trace),
        outer=sums.outer,
        size=sums.size,
        # counted in steps: logged times are whole nanoseconds
        elapsed=trace.clock.elapsed(step["step"][:-1], step["step"][1:]),
    )
    gaps = passes.imbalance(rows)
    if trace.events:
        gaps[changes.unknown_momentum(trace)] = 0.0
    return gaps


def _own_weight(trace: Trace) -> float:
    """Return the sum of m |g| times the radius of each movable body [J], |g| its largest."""
    scene = trace.config.scene
    strengths = [one.gravity for one in changes_of_gravity(trace.events)]
    pull = max(math.hypot(*one) for one in (scene.gravity, *strengths))
    bodies = [one for one in scene.bodies.values() if is_movable(one)]
    return pull * sum(mass_of(one) * bounding_radius(one.shape) for one in bodies)


def _lifted(trace: Trace, sums: ContactSums) -> Floats:
    """Return the most that the projection can lift in each step [J]."""
    pull = changes.strength_of_gravity(trace)
    if (
        trace.config.numerics.projection == 0.0
        or trace.config.engine is not None
        or not np.any(pull)
    ):
        return np.zeros(len(trace.step))
    lifted: Floats = pull * changes.masses(trace) * sums.opened
    return lifted
