"""Runs of many scenes in one engine, the union of what they require: poses and final velocities."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

import numpy as np

from lavendersim.engine.records import DIVERGED, ROWS_FULL
from lavendersim.experiment import load_experiment_text
from lavendersim.runner.plans import shared_plans
from lavendersim.scene.build import build
from tests.families_of_plans import spec_of_family

GRAVITY = 9.81  # [m/s^2], what a config has that specifies none


class States(NamedTuple):
    """One scene that was run; n bodies in the order of the file, k steps."""

    names: list[str]
    time: np.ndarray  # [s], (k + 1,)
    place: np.ndarray  # [m], (k + 1, n, 3)
    turn: np.ndarray  # quaternions w x y z, (k + 1, n, 4)
    velocity: np.ndarray  # [m/s], (k + 1, n, 3)
    spin: np.ndarray  # [rad/s], world axes, (k + 1, n, 3)
    step: np.ndarray  # rows of the steps, (k,)
    contact: np.ndarray  # rows of the contacts

    def of(self, body: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return places, velocities and spins of a body, (k + 1, 3) each."""
        i = self.names.index(body)
        return self.place[:, i], self.velocity[:, i], self.spin[:, i]

    def energy(self) -> np.ndarray:
        """Return kinetic and potential energy after every step [J]."""
        return self.step["kinetic_energy"] + self.step["potential_energy"]


def run_scenes(texts: Mapping[str, str]) -> dict[str, States]:
    """Run every scene, all in one engine; a scene is a config of one cell."""
    return dict(scenes_in_turn(texts))


def scenes_in_turn(texts: Mapping[str, str]) -> Iterator[tuple[str, States]]:
    """Yield every scene as it has been run."""
    cells = [load_experiment_text(text, f"{name}.yaml").cells()[0] for name, text in texts.items()]
    plans = shared_plans(cells)
    assert len({id(plan) for plan in plans}) == 1, "the scenes choose between laws"
    spec = spec_of_family(plans[0])
    for name, cell in zip(texts, cells, strict=True):
        scene = build(cell.config, spec)
        engine = scene.engine(spec)
        count, last = len(scene.names), cell.config.steps
        bodies, velocities, rows = [], [], []
        for number in range(last + 1):
            # Not through the log: its velocities are differences of places.
            while engine.counters["step"][0] < number:  # a call may end with rows to take, no step
                status = engine.advance(1)
                assert status != DIVERGED, f"{name} diverged in step {number}"
                if status == ROWS_FULL:
                    rows.append(engine.take_rows())
            bodies.append(engine.bodies[:count].tobytes())
            velocities.append(engine.velocities[:count].tobytes())
        rows.append(engine.take_rows())
        place, turn, velocity, spin = _states(
            np.frombuffer(b"".join(bodies), engine.bodies.dtype).reshape(-1, count),
            np.frombuffer(b"".join(velocities), engine.velocities.dtype).reshape(-1, count),
        )
        time = np.arange(last + 1) * float(cell.config.numerics.timestep)
        steps, contacts = (
            np.concatenate([getattr(one, kind) for one in rows]) for kind in ("step", "contact")
        )
        names = list(scene.names)
        yield name, States(names, time, place, turn, velocity, spin, steps, contacts)


def _states(bodies: np.ndarray, velocities: np.ndarray) -> tuple[np.ndarray, ...]:
    turn = _columns(bodies, ("qw", "qx", "qy", "qz"))
    turn[~turn.any(axis=(1, 2)), :, 0] = 1.0  # of a plan without rotation
    return (
        _columns(bodies, ("x", "y", "z")),
        turn,
        _columns(velocities, ("vx", "vy", "vz")),
        _columns(velocities, ("wx", "wy", "wz")),
    )


def _columns(records: np.ndarray, names: Iterable[str]) -> np.ndarray:
    """Return columns side by side; those the engine has no field for are 0."""
    have = records.dtype.names or ()
    nothing = np.zeros(records.shape)
    return np.stack([records[one] if one in have else nothing for one in names], axis=-1)


def orders(errors: Iterable[float]) -> list[float]:
    """Return the observed orders of errors at timesteps that are halved from one to the next."""
    return [math.log2(coarse / fine) for coarse, fine in itertools.pairwise(errors)]


def flow(values: Iterable[float]) -> str:
    """Return numbers as a YAML sequence, with all their digits."""
    return f"[{', '.join(repr(float(value)) for value in values)}]"


def ball(radius: float, mass: float, place: Iterable[float], velocity: Iterable[float] = ()) -> str:
    """Return a ball as a YAML mapping."""
    moving = f", velocity: {flow(velocity)}" if velocity else ""
    shape = f"{{kind: sphere, radius: {radius!r}}}"
    return f"{{shape: {shape}, mass: {mass!r}, position: {flow(place)}{moving}, surface: one}}"


def plane(normal: Iterable[float] = (0, 0, 1), offset: float = 0.0) -> str:
    """Return a plane n . x = offset as a YAML mapping."""
    return f"{{shape: {{kind: plane, normal: {flow(normal)}, offset: {offset!r}}}, surface: one}}"


def config(
    bodies: Mapping[str, str],
    rate: int,
    duration: float,
    surface: str = "restitution: 1",
    gravity: str = "0",
) -> str:
    """Return a config of bodies whose surfaces are one; rate: steps a second."""
    lines = "\n".join(f"    {name}: {body}" for name, body in bodies.items())
    return (
        f"scene:\n  gravity: {gravity}\n  surfaces: {{one: {{{surface}}}}}\n  bodies:\n{lines}\n"
        f"numerics: {{timestep: 1/{rate}}}\nduration: {duration!r}\n"
    )
