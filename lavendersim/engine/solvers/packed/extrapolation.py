"""A sweep begins where the last ones together lead: Anderson's acceleration (1965).

A sweep takes impulses x to y, and leaves the defect f = y - x. The next one begins from

    x = sum a_i y_i,    sum a_i = 1,    |sum a_i f_i| least

of the last DEPTH sweeps, in the metric of the rows' own inverse masses, so that light and heavy
bodies count alike. Velocities are linear in impulses: those of bodies are mixed by the same shares.
A sweep is not linear where contacts open, stick and slide anew. Where a defect has grown the sweep
before it is gone back to, all are forgotten, and some plain sweeps follow: a mixed beginning never
leaves more than it found. The last thing done is a sweep, so impulses end inside their cones.

The products of defects are kept, in place of the orthogonal columns of `anderson`: a sweep over
packed contacts takes some microseconds, and this as long.
"""

from __future__ import annotations

from typing import Any

from ...compile import inner, kernel
from ...spec import Spec
from .lane_memory import STRIDE, put_eight, take_eight
from .lanes import WIDTH, lane, spread, zeros
from .layout import DEPTH, GROUP, HEAD, K_N, K_T, LAMBDA_N, stride

# Sweeps kept where not even the beginning of the last one is known.
NOTHING = -1
# Plain sweeps after one that is taken back, at most: twice as many each time, one fewer each time
# that a beginning is mixed.
MOST_PAUSE = 64
# Square of a defect's difference to the newest, beside the newer ones, as a share of their squares,
# of which products have no digits: it adds no direction.
NEW = 1e-12


# Of the sweeps that are kept: the slot of the newest, how many, plain sweeps until one is kept, and
# plain sweeps after the next that is taken back.
SLOT, SWEEPS, WAIT, PAUSE = range(4)


@inner
def forget(packed):
    """Keep no sweep: what is swept is another problem, or another beginning."""
    counts = packed.kept.counts
    counts[SLOT], counts[SWEEPS], counts[WAIT], counts[PAUSE] = 0, NOTHING, 0, 1


def _make_keep(spec: Spec) -> Any:
    fields, impulses = stride(spec, True), LAMBDA_N * WIDTH

    def sum_of(lanes):
        total = 0.0
        for k in range(WIDTH):
            total += lane(lanes, k)
        return total

    sum_of = kernel(sum_of, spec)

    def keep(packed, groups, slot):
        rows, kept = packed.rows, packed.kept
        point, led_to, defects = kept.point, kept.led_to, kept.defects
        size = groups * GROUP
        first, second, third = (slot + 1) % DEPTH, (slot + 2) % DEPTH, (slot + 3) % DEPTH
        own, by_first, by_second, by_third = zeros(), zeros(), zeros(), zeros()
        for g in range(groups):
            for k in range(3):
                row, at = g * fields, g * GROUP + k * WIDTH
                y = take_eight(rows, row + impulses + k * WIDTH)
                f = y - take_eight(point, at)
                put_eight(led_to, slot * size + at, y)
                put_eight(defects, slot * size + at, f)
                weighed = f * take_eight(rows, row + (K_N if k == 0 else K_T) * WIDTH)
                own = own + weighed * f
                by_first = by_first + weighed * take_eight(defects, first * size + at)
                by_second = by_second + weighed * take_eight(defects, second * size + at)
                by_third = by_third + weighed * take_eight(defects, third * size + at)
        products = kept.products
        products[slot, slot] = sum_of(own)
        products[slot, first] = products[first, slot] = sum_of(by_first)
        products[slot, second] = products[second, slot] = sum_of(by_second)
        products[slot, third] = products[third, slot] = sum_of(by_third)
        state, states = packed.state, kept.states
        for at in range(HEAD * STRIDE, state.shape[0], STRIDE):
            put_eight(states, slot * state.shape[0] + at, take_eight(state, at))

    return kernel(keep, spec)


def _make_share(spec: Spec) -> Any:
    """Return `kernel(kept, slot, sweeps)`: the shares a_i of the least squares.

    By differences to the newest defect, newest first; slots that are not kept get 0.
    """

    def share(kept, slot, sweeps):
        products, shares, equations = kept.products, kept.shares, kept.equations
        own, unknowns = products[slot, slot], sweeps - 1
        for k in range(DEPTH):
            shares[k] = 0.0
        for i in range(unknowns):
            p = (slot + DEPTH - 1 - i) % DEPTH
            for j in range(unknowns):
                q = (slot + DEPTH - 1 - j) % DEPTH
                equations[i, j] = own - products[slot, p] - products[slot, q] + products[p, q]
            equations[i, unknowns] = own - products[slot, p]
        for i in range(unknowns):
            p = (slot + DEPTH - 1 - i) % DEPTH
            if equations[i, i] > NEW * (own + products[p, p]):
                for j in range(i + 1, unknowns):
                    factor = equations[j, i] / equations[i, i]
                    for k in range(i, unknowns + 1):
                        equations[j, k] -= factor * equations[i, k]
            else:
                equations[i, i] = 0.0
        newest = 1.0
        for i in range(unknowns - 1, -1, -1):
            if equations[i, i] > 0.0:
                left = equations[i, unknowns]
                for j in range(i + 1, unknowns):
                    left -= equations[i, j] * shares[(slot + DEPTH - 1 - j) % DEPTH]
                left /= equations[i, i]
                shares[(slot + DEPTH - 1 - i) % DEPTH] = left
                newest -= left
        shares[slot] = newest

    return kernel(share, spec)


def _make_mix(spec: Spec) -> Any:
    fields, impulses = stride(spec, True), LAMBDA_N * WIDTH

    def mixed(shares, vectors, size, at):
        return (
            spread(shares[0]) * take_eight(vectors, at)
            + spread(shares[1]) * take_eight(vectors, size + at)
            + spread(shares[2]) * take_eight(vectors, 2 * size + at)
            + spread(shares[3]) * take_eight(vectors, 3 * size + at)
        )

    mixed = kernel(mixed, spec)

    def mix(packed, groups):
        rows, state, kept = packed.rows, packed.state, packed.kept
        shares, led_to, states, size = kept.shares, kept.led_to, kept.states, groups * GROUP
        for g in range(groups):
            for k in range(3):
                at = g * GROUP + k * WIDTH
                x = mixed(shares, led_to, size, at)
                put_eight(rows, g * fields + impulses + k * WIDTH, x)
                put_eight(kept.point, at, x)
        size = state.shape[0]
        for at in range(HEAD * STRIDE, size, STRIDE):
            put_eight(state, at, mixed(shares, states, size, at))

    return kernel(mix, spec)


def make_extrapolate(spec: Spec) -> Any:
    """Return `kernel(packed, slots, ends)`, after a sweep and before the next one.

    ends: the next sweeps are the last ones, and begin where this one ended, or the one before where
    that left less. For contacts of a normal and a disc; begins with `forget`.
    """
    keep, share, mix = _make_keep(spec), _make_share(spec), _make_mix(spec)
    fields, impulses = stride(spec, True), LAMBDA_N * WIDTH

    def begin_here(packed, groups):
        for g in range(groups):
            for k in range(3):
                y = take_eight(packed.rows, g * fields + impulses + k * WIDTH)
                put_eight(packed.kept.point, g * GROUP + k * WIDTH, y)

    begin_here = kernel(begin_here, spec)

    def take_back(packed, groups, slot):
        shares = packed.kept.shares
        for k in range(DEPTH):
            shares[k] = 0.0
        shares[slot] = 1.0
        mix(packed, groups)

    take_back = kernel(take_back, spec)

    def extrapolate(packed, slots, ends):
        groups, products, counts = slots // WIDTH, packed.kept.products, packed.kept.counts
        if counts[WAIT] > 0:
            counts[WAIT] -= 1
            return
        if counts[SWEEPS] == NOTHING:
            begin_here(packed, groups)
            counts[SWEEPS] = 0
            return
        earlier = counts[SLOT]
        slot = (earlier + 1) % DEPTH
        keep(packed, groups, slot)
        grown = counts[SWEEPS] > 0 and not products[slot, slot] <= products[earlier, earlier]
        if grown and counts[SWEEPS] > 1:
            take_back(packed, groups, earlier)
            counts[SWEEPS], counts[WAIT] = NOTHING, counts[PAUSE]
            counts[PAUSE] = min(2 * counts[PAUSE], MOST_PAUSE)
            return
        sweeps = 1 if grown else min(counts[SWEEPS] + 1, DEPTH)
        counts[SLOT], counts[SWEEPS] = slot, sweeps
        if sweeps == 1 or ends:
            begin_here(packed, groups)
        else:
            share(packed.kept, slot, sweeps)
            mix(packed, groups)
            counts[PAUSE] = max(1, counts[PAUSE] - 1)

    return kernel(extrapolate, spec)
