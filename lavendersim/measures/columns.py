"""What several measures and figures take from a log: numbers by logged step, and by contact."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import count, takewhile

import numpy as np

from lavendersim.cell import Sphere, Surface
from lavendersim.cell.mixing import mixed
from lavendersim.engine.effects import rows_of_surfaces
from lavendersim.errors import UsageError
from lavendersim.geometry.bodies import is_movable, mass_of
from lavendersim.geometry.rotations import rotation_matrix, unit_quaternion
from lavendersim.geometry.shapes import extent, half_space
from lavendersim.measures import shares
from lavendersim.measures.changes import constant_gravity
from lavendersim.measures.interfaces import Floats, Rows, Trace


def step_column(trace: Trace, name: str) -> np.ndarray | None:
    """Return a column of `/step`; None where the scene does without it.

    NotReportedError where the engine does not report it: that is no log without violations.
    """
    step = trace.step
    if name in (step.dtype.names or ()) or name in getattr(step, "why", ()):
        return np.asarray(step[name])
    return None


def rows_of_steps(step: Rows, contacts: Rows) -> np.ndarray:
    """Return for each contact the row of its step; contacts are grouped by rising step.

    Each step is looked for among the contacts, not each contact among the steps: of thousands of
    contacts a step has hundreds.
    """
    ends = contacts["step"].searchsorted(step["step"], "right")
    counts = ends.copy()
    counts[1:] -= ends[:-1]
    rows: np.ndarray = np.arange(len(step)).repeat(counts)
    return rows


def contact_parts(trace: Trace) -> Iterator[Rows]:
    """Yield the contact rows of a log in parts of whole steps, for what is taken step by step.

    Of a log that has not all of them it is the empty table that says why.
    """
    if "/contacts" in trace.absent:
        yield trace.contact
        return
    yield from trace.contacts_in_parts()


def contacts_of(trace: Trace, body: str, other: str | None = None) -> Rows:
    """Return the contact rows of a body (with one other body, if named), in rising step.

    Of its surfaces: a taut rope has its row, a joint several, and they are none of them.
    """
    index = list(trace.bodies).index(body)
    rows = rows_of_surfaces(trace.contact)
    touches = (rows["body_a"] == index) | (rows["body_b"] == index)
    if other is not None:
        partner = list(trace.bodies).index(other)
        touches &= (rows["body_a"] == partner) | (rows["body_b"] == partner)
    chosen: Rows = rows if touches.all() else rows[touches]
    return chosen


def summed_by_step(trace: Trace, rows: Rows, field: str) -> Floats:
    """Return the sum of a contact field in every logged step; 0 where there is no contact.

    Normal impulses and forces are net: less what draws the bodies together.
    """
    positions = rows_of_steps(trace.step, rows)
    numbers = rows[field]
    net = field in ("impulse_n", "force_n")
    if net and shares.draws_together(rows) and shares.pull(rows).any():
        numbers = shares.net_impulse_n(rows)
        if field == "force_n":
            numbers = numbers / trace.clock.lengths(rows["step"])
    sums: Floats = np.bincount(positions, numbers, len(trace.step)).astype(np.float64, copy=False)
    return sums


def deepest_by_step(trace: Trace, rows: Rows) -> Floats:
    """Return the deepest penetration [m] in every logged step; 0 where there is no contact."""
    deepest = np.zeros(len(trace.step))
    np.maximum.at(deepest, rows_of_steps(trace.step, rows), rows["penetration"])
    return deepest


def impulses(contacts: Rows) -> Floats:
    """Return the impulse vector on B of each contact [N s] (n, 3), friction included."""
    normals = np.column_stack([contacts[f"n{axis}"] for axis in "xyz"])
    total: Floats = normals * shares.net_impulse_n(contacts)[:, None]
    if "impulse_t1" in (contacts.dtype.names or ()):
        first = np.column_stack([contacts[f"t1{axis}"] for axis in "xyz"])
        second = np.cross(normals, first)  # the frame (n, t1, t2) is right-handed
        total += first * contacts["impulse_t1"][:, None]
        total += second * contacts["impulse_t2"][:, None]
    return total


def of_pairs(contacts: Rows, surfaces: list[Surface], value: Callable[[Surface], float]) -> Floats:
    """Return a value of each contact's two surfaces, mixed.

    surfaces: of the bodies by their rows.
    """
    objects = {id(surface): surface for surface in surfaces}  # of many bodies there are a few
    different = list(dict.fromkeys(objects.values()))
    number = {surface: row for row, surface in enumerate(different)}
    row_of = {key: number[surface] for key, surface in objects.items()}
    rows = np.array([row_of[id(surface)] for surface in surfaces])
    pair = rows[contacts["body_a"]] * len(different) + rows[contacts["body_b"]]
    table = np.zeros(len(different) ** 2)
    present = np.zeros(len(table), dtype=bool)
    present[pair] = True
    for one in np.flatnonzero(present):
        a, b = divmod(int(one), len(different))
        table[one] = value(mixed(different[a], different[b]))
    values: Floats = table[pair]
    return values


def friction_of(trace: Trace, contacts: Rows) -> Floats:
    """Return mu of each contact by the config; by the log where it changes during the run."""
    if shares.surfaces_change(trace.config):
        logged: Floats = contacts["friction"]
        return logged
    surfaces = [trace.config.scene.bodies[name].surface for name in trace.bodies]
    mu = of_pairs(
        contacts,
        surfaces,
        lambda pair: np.nan if shares.varies_friction(pair) else pair.friction,
    )
    return np.where(np.isnan(mu), contacts["friction"], mu) if np.isnan(mu).any() else mu


def clearance_by_step(trace: Trace, body: str, plane: str) -> Floats:
    """Return the gap [m] between a body's surface and a plane in every logged state."""
    shape = trace.config.scene.bodies[body].shape
    normal, offset = half_space(trace.config.scene.bodies[plane].shape)
    poses = trace.pose[:, list(trace.bodies).index(body), :]
    heights: Floats = poses[:, :3] @ normal - offset
    if isinstance(shape, Sphere):
        return np.asarray(heights - shape.radius, dtype=np.float64)
    turns = [rotation_matrix(unit_quaternion(pose[3:])) for pose in poses]
    gaps: Floats = heights - np.array([extent(shape, turn, -normal) for turn in turns])
    return gaps


def runs_of(flags: np.ndarray) -> list[tuple[int, int]]:
    """Return [first, last] of every unbroken run of true flags."""
    padded = np.zeros(len(flags) + 2, bool)
    padded[1:-1] = flags
    (edges,) = (padded[1:] != padded[:-1]).nonzero()
    return [(int(first), int(end) - 1) for first, end in zip(edges[::2], edges[1::2], strict=True)]


def pushing_runs(trace: Trace, rows: Rows) -> list[tuple[int, int]]:
    """Return [first, last] row of every unbroken run of steps with a positive normal impulse."""
    return runs_of(summed_by_step(trace, rows, "impulse_n") > 0.0)


def last_window(trace: Trace, seconds: float) -> np.ndarray:
    """Return which steps lie in the last seconds of a run; none when the run is shorter."""
    time = trace.step["time"]
    if seconds > time[-1] - time[0]:
        return np.zeros(len(time), dtype=bool)
    window: np.ndarray = time > time[-1] - seconds * (1.0 - 1e-12)
    return window


def one_timestep(trace: Trace, first: int, last: int, measure: str) -> float:
    """Return the length [s] of the steps between two rows; UsageError where it changes."""
    lengths = set(trace.clock.lengths(trace.step["step"][first + 1 : last + 1]).tolist())
    if len(lengths) > 1:
        begin, end = (float(trace.step["time"][row]) for row in (first, last))
        raise UsageError(
            f"{measure} takes samples at equal distances, and the timestep changes among those it"
            f" needs, from {begin:.9g} to {end:.9g} s"
        )
    return float(lengths.pop())


def first_ending_after(trace: Trace, seconds: float) -> int | None:
    """Return the first logged step that ends after a time, None when there is none."""
    later = np.flatnonzero(trace.step["time"] > seconds)
    return int(later[0]) if len(later) else None


def body_columns(trace: Trace, bodies: Sequence[str]) -> list[int]:
    """Return the columns of these bodies in `pose`; of all that can move where none is named.

    The name of an arrangement stands for all that it has placed: NAME_1, NAME_2, ...
    """
    given = trace.config.scene.bodies.items()
    column = {name: place for place, name in enumerate(trace.bodies)}
    found: list[int] = []
    for name in bodies or [name for name, body in given if is_movable(body)]:
        members = [name] if name in column else takewhile(column.__contains__, _members(name))
        found += [column[member] for member in members]
    return found


def _members(arrangement: str) -> Iterator[str]:
    return (f"{arrangement}_{number}" for number in count(1))


def momentum(trace: Trace) -> Floats:
    """Return the scene's momentum [kg m/s] in every logged state (n, 3)."""
    return np.column_stack([trace.step[f"momentum_{axis}"] for axis in "xyz"])


def angular_momentum(trace: Trace) -> Floats:
    """Return the scene's angular momentum about the origin [kg m^2/s] in every state (n, 3)."""
    return np.column_stack([trace.step[f"angular_momentum_{axis}"] for axis in "xyz"])


def energy_at_rest(trace: Trace, body: str, plane: str, clearance: float) -> float:
    """Return the potential energy [J] of a scene whose only movable body rests on a plane.

    UsageError where an event changes gravity, and the energy with it.

    clearance: of the body in the first state [m], by which its potential energy there is larger.
    """
    scene = trace.config.scene
    normal = half_space(scene.bodies[plane].shape).normal
    pull = constant_gravity(trace, "energy above that at rest")
    weight = mass_of(scene.bodies[body]) * -float(normal @ pull)
    return float(trace.step["potential_energy"][0]) - weight * clearance


def mechanical_energy(trace: Trace) -> Floats:
    """Return kinetic plus potential energy [J] in every logged state."""
    with np.errstate(invalid="ignore"):  # of what is beyond all numbers
        energy: Floats = trace.step["kinetic_energy"] + trace.step["potential_energy"]
        energy = energy + shares.stored(trace)
    return energy
