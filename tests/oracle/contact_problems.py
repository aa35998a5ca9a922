"""Hard contact problems from a seed: boxes in stacks, heaps and between walls.

W = J M^-1 J^T and q = J v from bodies drawn at random, so that some solution exists: v = 0 is a
motion that every contact allows. What makes them hard is in their names: contacts that say the same
thing many times over, light below heavy, much or no friction, everything sliding.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy import sparse

from lavendersim.engine.contact_problem import ContactProblem
from lavendersim.problems.matrices import problem_of

WORLD = -1


class Box(NamedTuple):
    mass: float
    half: np.ndarray  # (3,) half edges
    at: np.ndarray  # (3,)


class Touch(NamedTuple):
    below: int  # A, or WORLD
    above: int  # B, or WORLD
    point: np.ndarray
    normal: np.ndarray  # from A to B


def crossed(arm: np.ndarray) -> np.ndarray:
    """Return the matrix of arm x ."""
    x, y, z = arm
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def frame(normal: np.ndarray) -> np.ndarray:
    """Return normal and two tangents as rows."""
    n = normal / np.linalg.norm(normal)
    t = np.cross(n, np.eye(3)[np.argmin(np.abs(n))])
    t /= np.linalg.norm(t)
    return np.stack([n, t, np.cross(n, t)])


def problem_of_boxes(boxes, touches, velocity: np.ndarray, mu) -> ContactProblem:
    """Return the problem of boxes that move by `velocity` (bodies, 6) if nothing pushes."""
    rows, inverse = np.zeros((3 * len(touches), 6 * len(boxes))), np.zeros((6 * len(boxes), 1))
    for k, box in enumerate(boxes):
        inertia = box.mass / 3.0 * (box.half @ box.half - box.half**2)
        inverse[6 * k : 6 * k + 6, 0] = [*[1.0 / box.mass] * 3, *1.0 / inertia]
    for c, touch in enumerate(touches):
        axes = frame(touch.normal)
        for body, sign in ((touch.below, -1.0), (touch.above, 1.0)):
            if body != WORLD:
                arm = crossed(touch.point - boxes[body].at)
                rows[3 * c : 3 * c + 3, 6 * body : 6 * body + 6] = sign * np.hstack(
                    [axes, -axes @ arm]
                )
    matrix = sparse.csc_matrix(rows @ (inverse * rows.T))
    return problem_of(matrix, rows @ velocity.ravel(), np.broadcast_to(mu, len(touches)))


def stack(seed: int, floors: int, ratio: float = 1.0, mu: float = 0.5, push: float = 0.3):
    """Return a tower of cubes on four corners each; the top one weighs `ratio` times the lowest."""
    rng = np.random.default_rng(seed)
    half = 0.5
    boxes, touches = [], []
    for k in range(floors):
        at = np.array([*rng.uniform(-0.1, 0.1, 2), half + 2.0 * half * k])
        boxes.append(Box(ratio ** (k / max(floors - 1, 1)), np.full(3, half), at))
        for corner in ((-1, -1), (-1, 1), (1, -1), (1, 1)):
            point = at + np.array([*(0.8 * half * np.array(corner)), -half])
            touches.append(Touch(k - 1, k, point, np.array([0.0, 0.0, 1.0])))
    velocity = push * rng.normal(size=(floors, 6)) * [1.0, 1.0, 0.0, 0.3, 0.3, 0.3]
    velocity[:, 2] = -0.0981
    return problem_of_boxes(boxes, touches, velocity, mu)


def heap(
    seed: int, bodies: int, ratio: float = 1.0, mu: float = 1.0, push: float = 1.0, corners: int = 3
):
    """Return boxes that touch neighbours and the world at `corners` places each, mu from 0 on."""
    rng = np.random.default_rng(seed)
    spread = bodies ** (1.0 / 3.0)
    boxes = [
        Box(ratio ** rng.uniform(), rng.uniform(0.3, 0.6, 3), spread * rng.normal(size=3))
        for _ in range(bodies)
    ]
    centres = np.array([box.at for box in boxes])
    touches = []
    for _ in range(int(2.2 * bodies)):
        above = int(rng.integers(bodies))
        at = centres[above]
        if rng.uniform() < 0.25:
            below, normal = WORLD, rng.normal(size=3)
            normal[2] = abs(normal[2]) + 0.5
            middle = at - 0.5 * normal / np.linalg.norm(normal)
        else:
            near = np.argsort(np.linalg.norm(centres - at, axis=1), kind="stable")[1:6]
            below = int(rng.choice(near))
            normal, middle = at - centres[below], 0.5 * (at + centres[below])
        tangents = frame(normal)[1:]
        for _ in range(corners):
            point = middle + rng.uniform(-0.3, 0.3, 2) @ tangents
            touches.append(Touch(below, above, point, normal))
    velocity = push * rng.normal(size=(bodies, 6)) * [1.0, 1.0, 1.0, 0.5, 0.5, 0.5]
    velocity[:, 2] -= 1.0
    return problem_of_boxes(boxes, touches, velocity, rng.uniform(0.0, mu, len(touches)))


def wedge(seed: int, bodies: int, mu: float):
    """Return cubes in a row, pressed between two walls by those at the ends."""
    rng = np.random.default_rng(seed)
    boxes = [Box(1.0, np.full(3, 0.5), np.array([float(k), 0.0, 0.0])) for k in range(bodies)]
    touches = [
        Touch(k - 1, k if k < bodies else WORLD, np.array([k - 0.5, y, z]), np.eye(3)[0])
        for k in range(bodies + 1)
        for y in (-0.4, 0.4)
        for z in (-0.4, 0.4)
    ]
    velocity = 0.2 * rng.normal(size=(bodies, 6))
    velocity[:, 2] -= 1.0
    velocity[0, 0] += 3.0
    velocity[-1, 0] -= 3.0
    return problem_of_boxes(boxes, touches, velocity, mu)


def skewed(problem: ContactProblem, seed: int, by: float = 1e-3) -> ContactProblem:
    """Return the problem with impulses turned a little: W is not symmetric then."""
    rng = np.random.default_rng(seed)
    turns = np.array([np.eye(3) + crossed(by * rng.normal(size=3)) for _ in problem.mu])
    columns = np.repeat(np.arange(problem.contacts), np.diff(problem.begin))
    return problem._replace(blocks=problem.blocks @ turns[columns])


def in_units(problem: ContactProblem, mass: float, velocity: float) -> ContactProblem:
    """Return the problem with numbers of mass and velocity so many times as large."""
    return problem._replace(
        blocks=problem.blocks / mass,
        gamma=problem.gamma / mass,
        free=problem.free * velocity,
        target=problem.target * velocity,
    )


def renumbered(problem: ContactProblem, seed: int) -> ContactProblem:
    """Return the problem with its contacts in another order."""
    order = np.random.default_rng(seed).permutation(problem.contacts)
    return _from_full(problem, lambda full: full[order][:, order], order)


def turned(problem: ContactProblem, seed: int) -> ContactProblem:
    """Return the problem with the tangents of every contact turned about its normal."""
    angles = np.random.default_rng(seed).uniform(0.0, 2.0 * np.pi, problem.contacts)
    turns = np.zeros((problem.contacts, 3, 3))
    turns[:, 0, 0] = 1.0
    turns[:, 1, 1] = turns[:, 2, 2] = np.cos(angles)
    turns[:, 1, 2], turns[:, 2, 1] = -np.sin(angles), np.sin(angles)
    columns = np.repeat(np.arange(problem.contacts), np.diff(problem.begin))
    blocks = turns[problem.row] @ problem.blocks @ turns[columns].transpose(0, 2, 1)
    return problem._replace(blocks=blocks, free=np.einsum("nij,nj->ni", turns, problem.free))


def _from_full(problem: ContactProblem, change: Callable, order: np.ndarray) -> ContactProblem:
    n = problem.contacts
    full = np.zeros((n, n, 3, 3))
    columns = np.repeat(np.arange(n), np.diff(problem.begin))
    full[problem.row, columns] = problem.blocks
    matrix = sparse.csc_matrix(change(full).transpose(0, 2, 1, 3).reshape(3 * n, 3 * n))
    made = problem_of(matrix, problem.free[order], problem.mu[order])
    return made._replace(gamma=problem.gamma[order], target=problem.target[order])


HARD: dict[str, Callable[[], ContactProblem]] = {
    "a tower of 12": lambda: stack(0, 12),
    "a tower of 30, nearly at rest": lambda: stack(1, 30, mu=0.7, push=0.05),
    "light below heavy": lambda: stack(0, 10, ratio=1e4),
    "heavy below light": lambda: stack(0, 10, ratio=1e-4, mu=0.6),
    "a sliding tower": lambda: stack(2, 8, mu=0.3, push=3.0),
    "a heap": lambda: heap(0, 20, mu=0.5),
    "a heap of one to ten thousand": lambda: heap(1, 20, ratio=1e4),
    "a frictional heap": lambda: heap(0, 20, mu=2.0),
    "a heap without friction": lambda: heap(0, 20, ratio=100.0, mu=0.0),
    "everything slides": lambda: heap(0, 20, mu=0.4, push=20.0),
    "six corners for each pair": lambda: heap(0, 10, corners=6),
    "wedged": lambda: wedge(0, 5, 1.0),
    "wedged and slipping": lambda: wedge(0, 8, 0.3),
    "in other units": lambda: in_units(heap(1, 20), 1e4, 1e-3),
    "not symmetric": lambda: skewed(heap(2, 20, mu=0.8), 2),
}
