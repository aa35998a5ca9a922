"""Kernels for what numbers of a log are expected to be, before their differences are written.

The operations of `trace.predictors` and `trace.sphere_contacts` in their order, each of which IEEE
754 rounds in one way alone, so that who reads the log finds the same bits. What is no number has
many bit patterns: where any comes up, the caller learns it, and asks the reader's own formulas.
Compiled once, for the contacts of all logs.
"""

from __future__ import annotations

from functools import cache
from math import sqrt

import numpy as np

from .compile import compiling, inner
from .difference_kernel import GAP, UNIT
from .kernel_cache import cached
from .spec import Spec

U = np.uint64
RADIUS, NORMAL, OFFSET = 0, 1, 4  # of a body, as in `trace.sphere_contacts`
TANGENTIAL = 3.5  # as in `trace.predictors`


def _unit(numbers, sources, i):
    x, y = numbers[sources[0], i], numbers[sources[1], i]
    left = 1.0 - x * x - y * y
    return sqrt(left) if left >= 0.0 else 0.0


def _gap(numbers, sources, i, timestep, slop):
    gap = numbers[sources[0], i] - slop
    return gap / timestep if gap > 0.0 else 0.0


def _law(numbers, sources, i):
    """Return Signorini's and Coulomb's natural maps of a row."""
    target, velocity = numbers[sources[0], i], numbers[sources[1], i]
    impulse_n, k_n = numbers[sources[2], i], numbers[sources[3], i]
    apart, pushed = velocity + target, impulse_n / (1.0 / k_n)
    normal = abs(pushed if pushed < apart or pushed != pushed else apart)
    k_t = TANGENTIAL * k_n
    scaled_1, scaled_2 = k_t * numbers[sources[5], i], k_t * numbers[sources[6], i]
    limit = k_t * numbers[sources[4], i] * impulse_n
    one, two = scaled_1 - numbers[sources[7], i], scaled_2 - numbers[sources[8], i]
    squared = one * one + two * two
    if squared > limit * limit:
        scale = limit / sqrt(squared)
        one, two = one * scale, two * scale
    one, two = one - scaled_1, two - scaled_2
    tangential = sqrt(one * one + two * two)
    return tangential if tangential > normal else normal


def _make_expect(spec: Spec):
    unit, gap, law = inner(_unit), inner(_gap), inner(_law)

    def expect(predictor, numbers, sources, constants, out):
        timestep, slop = constants
        wrong = 0
        if predictor == UNIT:
            for i in range(U(len(out))):
                out[i] = unit(numbers, sources, i)
        elif predictor == GAP:
            for i in range(U(len(out))):
                out[i] = gap(numbers, sources, i, timestep, slop)
        else:
            for i in range(U(len(out))):
                out[i] = law(numbers, sources, i)
        for i in range(U(len(out))):
            wrong += out[i] != out[i]
        return wrong

    return inner(expect)


def _make_place(spec: Spec):
    def place(keys, order, steps, bodies, positions, table):
        count = len(bodies)
        for i in range(U(len(order))):
            row = U(order[i])
            a, b = keys[0, row], keys[1, row]
            for k in range(8):
                table[k, i] = 0.0
            if a < 0 or a >= count or b < 0 or b >= count or not bodies[b, RADIUS] > 0.0:
                continue
            of_spheres = bodies[a, RADIUS] > 0.0
            p_x, p_y, p_z = bodies[a, NORMAL], bodies[a, NORMAL + 1], bodies[a, NORMAL + 2]
            if not (of_spheres or p_x != 0.0 or p_y != 0.0 or p_z != 0.0):
                continue
            step = U(steps[row])
            b_x, b_y, b_z = positions[step, b, 0], positions[step, b, 1], positions[step, b, 2]
            if of_spheres:
                x, y, z = positions[step, a, 0], positions[step, a, 1], positions[step, a, 2]
                d_x, d_y, d_z = b_x - x, b_y - y, b_z - z
                distance = sqrt(d_x * d_x + d_y * d_y + d_z * d_z)
                n_x, n_y, n_z = d_x / distance, d_y / distance, d_z / distance
                phi = distance - bodies[a, RADIUS] - bodies[b, RADIUS]
                reach = bodies[a, RADIUS] + 0.5 * phi
                x, y, z = x + reach * n_x, y + reach * n_y, z + reach * n_z
            else:
                n_x, n_y, n_z = p_x, p_y, p_z
                phi = n_x * b_x + n_y * b_y + n_z * b_z - bodies[a, OFFSET] - bodies[b, RADIUS]
                reach = bodies[b, RADIUS] + 0.5 * phi
                x, y, z = b_x - n_x * reach, b_y - n_y * reach, b_z - n_z * reach
            table[0, i], table[1, i], table[2, i] = x, y, z
            table[3, i], table[4, i], table[5, i], table[6, i] = n_x, n_y, n_z, phi
            for k in range(7):
                if table[k, i] != table[k, i]:
                    table[k, i] = 0.0
            table[7, i] = 1.0

    return inner(place)


@cache
def expect_numbers():
    """Return `kernel(predictor, numbers, sources, (timestep, slop), out)`.

    It fills out (n,) with what UNIT, GAP or LAW expects and returns how many are no numbers.
    numbers: (m, n) float64. sources: int64, rows of these in the order of `predictors.SPECIAL`.
    """
    kernel = cached(_make_expect, Spec())
    floats, table, ints = np.zeros(0), np.zeros((0, 0)), np.zeros(0, np.int64)
    with compiling():  # here, and not in one of the threads that close chunks
        kernel(UNIT, table, ints, (0.0, 0.0), floats)
    return kernel


@cache
def place_contacts():
    """Return `kernel(keys, order, steps, bodies, positions, table)`.

    It fills table (8, n) with what is expected of contacts in an order: x y z nx ny nz separation,
    and 1 where they are known, of spheres, or of a plane and a sphere; else 0. keys: (k, n) int64,
    bodies first. order, steps: (n,) int64. bodies: (b, 8). positions: (s, b, 3), by steps.
    """
    kernel = cached(_make_place, Spec())
    table, ints = np.zeros((0, 0)), np.zeros(0, np.int64)
    with compiling():
        kernel(np.zeros((2, 0), np.int64), ints, ints, table, np.zeros((0, 0, 0)), table)
    return kernel
