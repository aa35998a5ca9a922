"""The laws that the log of any run must keep; a sentence for each that a config's two runs break.

Nothing is asked of accuracy here: a few sweeps at a thirtieth of a second solve little. What is
asked holds for any sweep of any solver: contacts push, friction stays within its cone, the log is
consistent with itself, a state that is no number ends the run and says whose it is, the same run
gives the same bits, in one piece or step by step, and in another unit of mass (`fuzz_units`), and
what `fuzz_balances` says of each step.
"""

from __future__ import annotations

import math
import time
import warnings
from concurrent.futures import ThreadPoolExecutor, wait
from typing import Any, NamedTuple

import numpy as np
import yaml
from fuzz_balances import unbalanced
from fuzz_steps import Tables, joined, tables_of
from fuzz_units import differences, heavier, rounds

from lavendersim.cell import CellConfig
from lavendersim.engine.effects.joint_models import JOINTS
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

# A run takes milliseconds; some of springs beside contacts a second a step, thrice over. One that
# takes that long is a find, on however busy a machine.
LIMIT = 120.0  # [s] of the processor
LOOK = 1.0  # [s] between two looks at how long it took
ENDLESS = "ends: still runs after"
# The cone is kept by scaling with a rounded length: some units in the last place.
ROUNDING = 1e-12
# Components that small are squared below the least number: their length is known to so much.
UNDERFLOW = 1e-150
DUMPER = getattr(yaml, "CSafeDumper", yaml.SafeDumper)  # libyaml's writes the same text, faster
SQUARES = ("kinetic_energy", "dissipation")  # columns that are products of two velocities
BLOCK = 16  # steps that rows are held for: some blocks end within each run


class Ended(NamedTuple):
    """How a run ended: its rows, and a sentence where it diverged."""

    rows: Rows
    steps: int
    said: str
    scene: Scene
    engine: Engine
    states: list[tuple[Tables, Tables]]  # before and after each step, where each is a call

    @property
    def finite(self) -> int:
        """How many steps ended with numbers: not the one that diverged.

        Of substeps the one that diverges, or that is not accurate, is taken back.
        """
        taken_back = self.engine.spec.has("error_control")
        return self.steps - bool(self.said and not taken_back)


def text_of(tree: dict[str, Any]) -> str:
    """Return a config as a file."""
    text: str = yaml.dump(tree, Dumper=DUMPER, sort_keys=False, default_flow_style=None, width=100)
    return text


def loaded(tree: dict[str, Any]) -> tuple[Experiment, Spec]:
    """Return a config as it is read from a file, and the structure of its engine."""
    experiment = load_experiment_text(text_of(tree), "fuzz.yaml")
    return experiment, plan_of_cell(experiment.cells()[0]).spec


def run(
    config: CellConfig, spec: Spec, steps: int, by_step: bool = False, enough: float = math.inf
) -> Ended:
    """Run a cell to its end, as a cell of an experiment is run; or one step at a time.

    enough: [s] of the processor, after which it ends step by step, too.
    """
    scene = build(config, spec)
    engine = scene.engine(spec, BLOCK)
    events = EventQueue(engine, scene, config.events, config.triggered)
    blocks, status, done, states = [], RUNNING, 0, []
    before: Tables | None = None
    engine.advance(0)  # as a run does: triggers may be met by the initial state
    begin = time.process_time()
    while True:
        events.apply_due(done)
        if by_step and before is None:  # what fills the log in the middle of a step goes on in it
            before = tables_of(engine, scene)
        if done < steps:
            status = engine.advance(1 if by_step else events.next_stop(steps) - done)
        if before is not None and int(engine.counters["step"][0]) > done:
            states.append((before, tables_of(engine, scene)))
            before = None
        done = int(engine.counters["step"][0])
        blocks.append(engine.take_rows())
        if status == DIVERGED or (status == RUNNING and done >= steps):
            break
        if by_step and before is None and time.process_time() - begin > enough:
            break
    rows = Rows(*(joined(columns) for columns in zip(*blocks, strict=True)))
    said = divergence(scene, engine) if status == DIVERGED else ""
    return Ended(rows, done, said, scene, engine, states)


class Judged(NamedTuple):
    """What a run was found to break, and the laws that had something to say of it."""

    broken: list[str]
    laws: list[str]


def broken(tree: dict[str, Any], shared: Spec | None = None) -> list[str]:
    """Return every law that a config breaks, by name and number; none where all is well."""
    return judged(tree, shared).broken


def judged(tree: dict[str, Any], shared: Spec | None = None, enough: float = math.inf) -> Judged:
    """Return what a config breaks, by name and number.

    shared: the engine it must require. enough: [s] of the processor; of a run that takes longer,
    the steps are judged that are done by then.
    """
    pool = ThreadPoolExecutor(1)
    try:
        begin, judging = time.process_time(), pool.submit(_judged, tree, shared, enough)
        while not wait([judging], LOOK).done:  # kernels hold no lock of Python's
            if time.process_time() - begin > LIMIT:
                return Judged([f"{ENDLESS} {LIMIT:g} s"], [])
        return judging.result()
    except Exception as error:  # whatever it is, it is a find
        return Judged([f"crash: {type(error).__name__}: {error}"], [])
    finally:
        pool.shutdown(wait=False)


def _judged(tree: dict[str, Any], shared: Spec | None, enough: float) -> Judged:
    experiment, spec = loaded(tree)
    if shared is not None and spec != shared:
        return Judged(["plan: it requires another engine than its plan's"], [])
    cell = experiment.cells()[0]
    config = cell.config
    other = run(config, spec, config.steps, by_step=True, enough=enough)
    steps = config.steps if other.said else other.steps
    one = run(config, spec, steps)
    found = [
        f"equal runs: {name} differ"
        for name in Rows._fields
        if not _equal(getattr(one.rows, name), getattr(other.rows, name))
    ]
    if one.said != other.said:
        found.append(f"equal runs: `{one.said}` and `{other.said}`")
    with warnings.catch_warnings():  # of numbers near the greatest, squared
        warnings.simplefilter("ignore", RuntimeWarning)
        found += _ending(one, steps)
        found += _counts(one, config)
        found += _connected(one, config)
        found += _contacts(one, config.numerics.friction_cone)
        found += _immovable(one, config)
        unlike, laws = unbalanced(config, other.rows, other.states, other.finite)
        found += unlike
        laws += ["push"] if len(one.rows.contact) else []
        if not one.said and not rounds(one.rows):
            heavy = run(heavier(config), spec, steps).rows
            if not rounds(heavy):  # what is 0 in one unit may be the least number in another
                found += differences(one.rows, heavy)
                laws.append("units")
    return Judged(found, [*laws, "diverged" if one.said else "ended"])


def _equal(one: np.ndarray, other: np.ndarray) -> bool:
    """Whether two tables have the same bits; not those between columns, which nobody writes."""
    names = one.dtype.names
    if names is None:
        return one.tobytes() == other.tobytes()
    return all(one[name].tobytes() == other[name].tobytes() for name in names)


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
    last = run.finite + 1  # the step that diverged may be no number
    for name in ("step", "contact", "residual"):
        table = getattr(rows, name)
        # What grows beyond all numbers does so in its square first, and is reported a step later.
        columns = _odd(table[table["step"] < last], SQUARES if run.said else ())
        if columns:
            found.append(f"finite: {', '.join(columns)} of {name}")
    kept = rows.pose[:last]
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


def _connected(run: Ended, config: CellConfig) -> list[str]:
    """A row that says that it is of a rope or a joint is of the two bodies that this connects."""
    rows, connections = run.rows.contact, [*config.scene.connections.values()]
    found = []
    for column, kinds in (("rope", ("rope",)), ("joint", JOINTS)):
        if column not in (rows.dtype.names or ()):
            continue
        own = rows[rows[column] != 0]
        two = [[run.scene.names.index(name) for name in one.between]
               for one in connections if one.kind in kinds]  # fmt: skip
        known = (own[column] >= 1) & (own[column] <= len(two))
        if not known.all():
            found.append(f"counts: a row of {column} {own[column][~known][0]} of {len(two)}")
            continue
        pairs = np.sort(np.array(two, dtype=int).reshape(-1, 2), axis=1)[own[column] - 1]
        if (pairs != np.sort(np.column_stack([own["body_a"], own["body_b"]]), axis=1)).any():
            found.append(f"counts: a row of a {column} of two other bodies")
    return found


def _contacts(run: Ended, cone: str) -> list[str]:
    """Contacts push along a unit normal; what resists sliding and turning stays in its cone."""
    rows = run.rows.contact
    rows = rows[rows["step"] <= run.finite]
    found = []
    names = rows.dtype.names or ()
    if "joint" in names:  # its rows have no cone, a couple no normal
        rows = rows[rows["joint"] == 0]
    normal = np.sqrt(rows["nx"] ** 2 + rows["ny"] ** 2 + rows["nz"] ** 2)
    if (~(np.abs(normal - 1.0) <= 1e-9)).any():
        found.append(f"unit: a normal of length {normal[np.argmax(np.abs(normal - 1.0))]!r}")
    push = rows["impulse_n"]
    if (push < 0.0).any():
        found.append(f"push: an impulse of {push.min():g} N s")
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
    if "friction_11" in names and cone != "pyramid":  # which has no ellipse: no grain is drawn
        limited.append(("friction", _in_ellipse(rows), np.ones(len(rows))))
    for name, impulse, coefficient in limited:
        most = coefficient * push
        outside = impulse > most * (1.0 + ROUNDING) + UNDERFLOW
        if outside.any():
            k = int(np.argmax(impulse - most))
            said = f"{impulse[k]:g} of at most {most[k]:g} in step {rows['step'][k]}"
            law = "cone" if name == "friction" else "torque"
            found.append(f"{law}: {name} of {said}")
    return found


def _in_ellipse(rows: np.ndarray) -> np.ndarray:
    """Return |F^-1 lambda_t| of friction with a grain, 0 where F is singular."""
    a, b, c = rows["friction_11"], rows["friction_12"], rows["friction_22"]
    one, two = rows["impulse_t1"], rows["impulse_t2"]
    flat = a * c - b * b
    sizes = np.maximum(a, c) ** 2
    known = flat > 1e-6 * sizes  # a needle of an ellipse says nothing of what lies across it
    flat = np.where(known, flat, 1.0)
    length: np.ndarray = np.hypot(c * one - b * two, a * two - b * one) / flat
    return np.where(known, length * (1.0 - 1e-9), 0.0)  # F is known to 1e-16 of 1e-6 of its size


def _immovable(run: Ended, config: CellConfig) -> list[str]:
    """What is fixed or removed stays where it is; what is kinematic keeps its velocity."""
    # Velocities may follow; of the step that diverged nothing is a number.
    states = run.rows.pose[: run.finite + 1]
    found, poses = [], states[:, :, :7]
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
            if (states[:, k, 7:] != [*body.velocity, *body.angular_velocity]).any():
                found.append(f"immovable: {name} is kinematic, and its velocity changed")
        elif body.fixed and (states[:, k] != states[0, k]).any():
            found.append(f"immovable: {name} is fixed, and moved")
    return found
