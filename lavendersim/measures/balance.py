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
events gave, so far. A step solved
to the residual r creates at most r times the sum of its impulses: at 1e-9 m/s a ball of 0.1 m at
rest needs 100 s to reach 1e-6 of its weight times its radius, at the worst.
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

from lavendersim.geometry.bodies import is_movable, mass_of, vector
from lavendersim.geometry.shapes import bounding_radius
from lavendersim.measures import changes, shares
from lavendersim.measures.columns import mechanical_energy
from lavendersim.measures.contact_sums import ContactSums
from lavendersim.measures.interfaces import Floats, Trace


class EnergyBalance:
    """The energy a run has gained, state by state; a log may come in several sections."""

    def __init__(self) -> None:
        self._begun = False
        self._given = self._lowest = self._lowest_potential = self._worked = self._put_in = 0.0
        self._own_weight = self._first_potential = self._first_kinetic = 0.0

    def created(self, trace: Trace, sums: ContactSums) -> Floats:
        """Return, in every state, the energy gained since it was lowest over that at play [-].

        trace: a log, or its next section: the last state that was counted, without its
        contacts, and what follows.
        """
        potential = trace.step["potential_energy"] + shares.stored(trace)
        if not self._begun:
            self._begun = True
            self._lowest = math.inf
            self._lowest_potential = self._first_potential = float(potential[0])
            self._first_kinetic = float(trace.step["kinetic_energy"][0])
            self._own_weight = _own_weight(trace)
        work, events = changes.work_of_forces(trace), changes.given_by_events(trace)
        given = _summed(self._given, work + events + _lifted(trace, sums) + sums.pulled)
        own = mechanical_energy(trace) - given
        lowest = np.minimum(np.minimum.accumulate(own), self._lowest)
        lowest_potential = np.minimum(np.minimum.accumulate(potential), self._lowest_potential)
        worked = _summed(self._worked, np.abs(work))
        put_in = _summed(self._put_in, np.maximum(events, 0.0))
        self._given, self._lowest = float(given[-1]), float(lowest[-1])
        self._lowest_potential = float(lowest_potential[-1])
        self._worked, self._put_in = float(worked[-1]), float(put_in[-1])
        with np.errstate(invalid="ignore"):  # of what is beyond all numbers
            created = own - lowest
        at_play = (
            self._first_kinetic
            + self._own_weight
            + np.maximum(self._first_potential - lowest_potential, 0.0)
            + worked
            + put_in
        )
        with np.errstate(invalid="ignore", divide="ignore"):
            share = np.where(at_play > 0.0, created / at_play, np.where(created > 0.0, np.inf, 0.0))
        # nothing that is not finite may pass
        result: Floats = np.where(np.isfinite(created), share, np.nan)
        return result


def _summed(before: float, numbers: Floats) -> Floats:
    """Return the running sum behind what was summed before, rounded as if it were one."""
    sums: Floats = np.cumsum(np.concatenate(([before], numbers)))[1:]
    return sums


def momentum_imbalance(trace: Trace, sums: ContactSums) -> Floats:
    """Return the part of each step's change of momentum without a cause, over all causes [-]."""
    gaps = np.zeros(len(trace.step))
    momentum = np.column_stack([trace.step[f"momentum_{axis}"] for axis in "xyz"])
    # counted in steps: logged times are whole nanoseconds
    dt = trace.clock.elapsed(trace.step["step"][:-1], trace.step["step"][1:])
    gravity, mass = vector(trace.config.scene.gravity), changes.masses(trace)
    forces = changes.forces(trace)
    others = shares.outer_impulse(trace)
    outer, size = sums.outer + others, sums.size + np.sqrt((others**2).sum(axis=1))
    expected = (mass[1:, None] * gravity + forces[1:]) * dt[:, None] + outer[1:]
    imbalance = np.diff(momentum, axis=0) - expected
    carried = np.sqrt(2.0 * mass * trace.step["kinetic_energy"])
    enters = size[1:] + carried[1:] + carried[:-1]
    enters += (mass[1:] * math.hypot(*gravity) + np.sqrt((forces[1:] ** 2).sum(axis=1))) * dt
    lengths = np.sqrt((imbalance**2).sum(axis=1))
    with np.errstate(invalid="ignore", divide="ignore"):
        gaps[1:] = np.where(lengths == 0.0, 0.0, lengths / enters)
    gaps[changes.unknown_momentum(trace)] = 0.0
    return gaps


def _own_weight(trace: Trace) -> float:
    """Return the sum of m |g| times the radius of each movable body [J]."""
    pull = math.hypot(*trace.config.scene.gravity)
    bodies = [one for one in trace.config.scene.bodies.values() if is_movable(one)]
    return pull * sum(mass_of(one) * bounding_radius(one.shape) for one in bodies)


def _lifted(trace: Trace, sums: ContactSums) -> Floats:
    """Return the most that the projection can lift in each step [J]."""
    pull = math.hypot(*trace.config.scene.gravity)
    if trace.config.numerics.projection == 0.0 or pull == 0.0:
        return np.zeros(len(trace.step))
    lifted: Floats = pull * changes.masses(trace) * sums.opened
    return lifted
