"""The laws that the log of any run must keep; a sentence for each that a config's two runs break.

Nothing is asked of accuracy here: a few sweeps at a thirtieth of a second solve little. What is
asked holds for any sweep of any solver: contacts push, friction stays within its cone, the log is
consistent with itself, a state that is no number ends the run and says whose it is, the same run
gives the same bits, in one piece or step by step, and in another unit of mass (`fuzz_units`), and
what `fuzz_balances` says of each step.
"""

from __future__ import annotations

import warnings
from concurrent.futures import ThreadPoolExecutor, TimeoutError
from typing import Any, NamedTuple

import numpy as np
import yaml
from fuzz_balances import State, state_of, unbalanced
from fuzz_units import differences, heavier

from lavendersim.cell import CellConfig
from lavendersim.engine.engine import Engine, Rows
from lavendersim.engine.records import DIVERGED, RUNNING
from lavendersim.engine.spec import Spec
from lavendersim.experiment.experiment import Experiment
from lavendersim.experiment.load import load_experiment_text
from lavendersim.quantities.scalars import exact
from lavendersim.runner.cell import divergence
from lavendersim.scene.build import Scene, build
from lavendersim.scene.events import EventQueue
from lavendersim.scene.plan import plan_of_cell

# A run takes milliseconds; one that has not ended by now never will, on however busy a machine.
LIMIT = 120.0  # [s]
# The cone is kept by scaling with a rounded length: some units in the last place.
ROUNDING = 1e-12
# Components that small are squared below the least number: their length is known to so much.
UNDERFLOW = 1e-150
SQUARES = ("kinetic_energy", "dissipation")  # columns that are products of two velocities
BLOCK = 16  # steps that rows are held for: some blocks end within each run


class Ended(NamedTuple):
    """How a run ended: its rows, and a sentence where it diverged."""

    rows: Rows
    steps: int
    said: str
    scene: Scene
    engine: Engine
    states: list[tuple[State, State]]  # before and after each step, where each is a call


def text_of(tree: dict[str, Any]) -> str:
    """Return a config as a file."""
    text: str = yaml.safe_dump(tree, sort_keys=False, default_flow_style=None, width=100)
    return text


def loaded(tree: dict[str, Any]) -> tuple[Experiment, Spec]:
    """Return a config as it is read from a file, and the structure of its engine."""
    experiment = load_experiment_text(text_of(tree), "fuzz.yaml")
    return experiment, plan_of_cell(experiment.cells()[0]).spec


def run(config: CellConfig, spec: Spec, steps: int, by_step: bool = False) -> Ended:
    """Run a cell to its end, as a cell of an experiment is run; or one step at a time."""
    scene = build(config, spec)
    engine = scene.engine(spec, BLOCK)
    events = EventQueue(engine, scene, config.events, config.triggered)
    blocks, status, done, states = [], RUNNING, 0, []
    engine.advance(0)  # as a run does: triggers may be met by the initial state
    while True:
        events.apply_due(done)
        before = state_of(engine, scene) if by_step else None
        if done < steps:
            status = engine.advance(1 if by_step else events.next_stop(steps) - done)
        if before is not None and int(engine.counters["step"][0]) > done:
            states.append((before, state_of(engine, scene)))
        done = int(engine.counters["step"][0])
        blocks.append(engine.take_rows())
        if status == DIVERGED or (status == RUNNING and done >= steps):
            break
    rows = Rows(*(np.concatenate(columns) for columns in zip(*blocks, strict=True)))
    said = divergence(scene, engine) if status == DIVERGED else ""
    return Ended(rows, done, said, scene, engine, states)


def broken(tree: dict[str, Any], shared: Spec | None = None) -> list[str]:
    """Return every law that a config breaks, by name and number; none where all is well.

    shared: the engine it must require.
    """
    pool = ThreadPoolExecutor(1)
    try:
        return pool.submit(_broken, tree, shared).result(LIMIT)  # kernels hold no lock of Python's
    except TimeoutError:
        return [f"ends: still runs after {LIMIT:g} s"]
    except Exception as error:  # whatever it is, it is a find
        return [f"crash: {type(error).__name__}: {error}"]
    finally:
        pool.shutdown(wait=False)


def _broken(tree: dict[str, Any], shared: Spec | None) -> list[str]:
    experiment, spec = loaded(tree)
    if shared is not None and spec != shared:
        return ["plan: it requires another engine than its plan's"]
    cell = experiment.cells()[0]
    config, steps = cell.config, cell.config.steps
    one, other = run(config, spec, steps), run(config, spec, steps, by_step=True)
    found = [
        f"equal runs: {name} differ"
        for name in Rows._fields
        if getattr(one.rows, name).tobytes() != getattr(other.rows, name).tobytes()
    ]
    if one.said != other.said:
        found.append(f"equal runs: `{one.said}` and `{other.said}`")
    with warnings.catch_warnings():  # of numbers near the greatest, squared
        warnings.simplefilter("ignore", RuntimeWarning)
        found += _ending(one, steps)
        found += _counts(one, config)
        found += _contacts(one, config.numerics.friction_cone)
        found += _immovable(one, config)
        found += unbalanced(config, other.rows, other.states, other.steps - bool(other.said))
        if not one.said:
            (twin,) = loaded(heavier(tree))[0].cells()
            found += differences(one.rows, run(twin.config, spec, steps).rows)
    return found


def _odd(rows: np.ndarray, but: tuple[str, ...]) -> list[str]:
    """Return the columns of a table that are not finite everywhere."""
    names = [name for name in rows.dtype.names or () if name not in but]
    return [name for name in names if not np.isfinite(rows[name].astype(float)).all()]


def _ending(run: Ended, steps: int) -> list[str]:
    """A run does all its steps, or says who made it end; what it logged before is finite."""
    rows, found = run.rows, []
    if not run.said and run.steps != steps:
        found.append(f"ends: {run.steps} of {steps} steps, without a word")
    if run.said and (
        not run.said.startswith("diverged: body ")
        or not any(f" {name} " in run.said for name in run.scene.names)
        or f"after step {run.steps} (t = " not in run.said
    ):
        found.append(f"ends: `{run.said}` tells neither whose state, step nor time")
    last = run.steps if run.said else run.steps + 1  # the step that diverged may be no number
    for name in ("step", "contact", "residual"):
        table = getattr(rows, name)
        # What grows beyond all numbers does so in its square first, and is reported a step later.
        columns = _odd(table[table["step"] < last], SQUARES if run.said else ())
        if columns:
            found.append(f"finite: {', '.join(columns)} of {name}")
    kept = rows.pose[: last if run.said else None]
    if not np.isfinite(kept).all():
        found.append("finite: a pose is no number")
    else:
        length = np.linalg.norm(kept[:, :, 3:7], axis=2)
        if np.abs(length - 1.0).max() > ROUNDING:
            found.append(f"unit: a quaternion of length 1 {np.abs(length - 1.0).max():+g}")
    return found


def _counts(run: Ended, config: CellConfig) -> list[str]:
    """The rows of the log fit each other."""
    step, contact, residual = run.rows.step, run.rows.contact, run.rows.residual
    found = []
    if not np.array_equal(step["step"], np.arange(run.steps + 1)):
        found.append("counts: steps are not 0, 1, 2, ...")
    if len(run.rows.pose) != len(step):
        found.append(f"counts: {len(run.rows.pose)} poses of {len(step)} steps")
    counted = np.bincount(contact["step"], minlength=run.steps + 1)
    if not np.array_equal(counted, step["contact_count"]):
        found.append("counts: contact_count is not the number of contacts")
    bodies = len(run.scene.names)
    a, b = contact["body_a"], contact["body_b"]
    if ((a == b) | (np.minimum(a, b) < 0) | (np.maximum(a, b) >= bodies)).any():
        found.append("counts: a contact of a body with itself, or with none")
    if (step["residual_contact"] >= np.maximum(step["contact_count"], 1)).any():
        found.append("counts: residual_contact names no contact")
    deepest = np.zeros(len(step))
    np.maximum.at(deepest, contact["step"], contact["penetration"])
    fine = np.isfinite(step["max_penetration"])
    if not np.array_equal(deepest[fine], step["max_penetration"][fine]):
        found.append("counts: max_penetration is not the deepest of the contacts")
    asked = config.numerics.sweeps
    if len(residual) and residual["sweep"].max() > asked:
        found.append(f"counts: sweep {residual['sweep'].max()} of {asked}")
    same = np.diff(residual["step"]) == 0
    if (np.diff(residual["step"]) < 0).any() or (np.diff(residual["sweep"])[same] <= 0).any():
        found.append("counts: sweeps of a step are logged twice, or out of order")
    return found


def _contacts(run: Ended, cone: str) -> list[str]:
    """Contacts push along a unit normal; what resists sliding and turning stays in its cone."""
    rows = run.rows.contact
    rows = rows[rows["step"] < run.steps] if run.said else rows
    found = []
    normal = np.sqrt(rows["nx"] ** 2 + rows["ny"] ** 2 + rows["nz"] ** 2)
    if (~(np.abs(normal - 1.0) <= 1e-9)).any():
        found.append(f"unit: a normal of length {normal[np.argmax(np.abs(normal - 1.0))]!r}")
    push = rows["impulse_n"]
    if (push < 0.0).any():
        found.append(f"push: an impulse of {push.min():g} N s")
    names = rows.dtype.names or ()
    limited: list[tuple[str, np.ndarray, np.ndarray]] = []
    if "impulse_t1" in names:
        one, two = rows["impulse_t1"], rows["impulse_t2"]
        slide = np.hypot(one, two) if cone != "pyramid" else np.maximum(np.abs(one), np.abs(two))
        limited.append(("friction", slide, rows["friction"]))
    if "angular_impulse_n" in names:
        spin = np.abs(rows["angular_impulse_n"])
        limited.append(("torsional friction", spin, rows["torsional_friction"]))
    if "angular_impulse_t1" in names:
        roll = np.hypot(rows["angular_impulse_t1"], rows["angular_impulse_t2"])
        limited.append(("rolling friction", roll, rows["rolling_friction"]))
    for name, impulse, coefficient in limited:
        most = coefficient * push
        outside = impulse > most * (1.0 + ROUNDING) + UNDERFLOW
        if outside.any():
            k = int(np.argmax(impulse - most))
            said = f"{impulse[k]:g} of at most {most[k]:g} in step {rows['step'][k]}"
            law = "cone" if name == "friction" else "torque"
            found.append(f"{law}: {name} of {said}")
    return found


def _immovable(run: Ended, config: CellConfig) -> list[str]:
    """What is fixed or removed stays where it is; what is kinematic keeps its velocity."""
    found, poses = [], run.rows.pose[:, :, :7]  # velocities may follow
    removed = {event.body: event.at for event in config.events if getattr(event, "remove", False)}
    for k, (name, body) in enumerate(config.scene.bodies.items()):
        if name in removed:
            first = run.scene.clock.steps_until(exact(removed[name]))
            if (poses[first:, k] != poses[first : first + 1, k]).any():
                found.append(f"immovable: {name} is removed, and moved")
            rows = run.rows.contact[run.rows.contact["step"] > first]
            if ((rows["body_a"] == k) | (rows["body_b"] == k)).any():
                found.append(f"immovable: {name} is removed, and touched")
        elif body.kinematic and body.motion:
            continue  # `tests/physics/test_functions_of_time.py`
        elif body.kinematic:
            velocity = [float(run.engine.velocities[k][f"v{axis}"]) for axis in "xyz"]
            if velocity != list(body.velocity):
                found.append(f"immovable: {name} is kinematic, and its velocity changed")
        elif body.fixed and (run.rows.pose[:, k] != run.rows.pose[0, k]).any():
            found.append(f"immovable: {name} is fixed, and moved")
    return found
