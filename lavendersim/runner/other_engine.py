"""One cell run by another engine: its process, its rows, its log; see `cell.simulate`.

The engine steps in a process of its own. One that crashes, hangs or cannot build the scene is how
the cell ended, and said in its status; the log has what was done before.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lavendersim.cell import CellConfig, CellEngine
from lavendersim.engine.compile import clock_without_compiling, compiled_ns
from lavendersim.errors import NOT_REPORTED
from lavendersim.geometry.bodies import is_movable
from lavendersim.measures.always import WorstStates
from lavendersim.peers.catalogue import installed_version, peer_of
from lavendersim.peers.declaration import Peer
from lavendersim.peers.messages import Built, States, Task
from lavendersim.peers.process import messages_of
from lavendersim.trace import TraceWriter, Written
from lavendersim.trace.recorded import described, partly_recorded
from lavendersim.trace.schema import CONTACT_COLUMNS, STEP_COLUMNS
from lavendersim.trace.writer import NOT_REPORTED_COLUMNS

from .accuracy import Accuracy
from .bounds import Bounds
from .cell_outcome import CellOutcome
from .environment import versions
from .interruption import deferred
from .other_rows import RowsOfStates, contact_columns, step_columns

if TYPE_CHECKING:
    from .cell import CellJob

CONTACTS = ("/contacts", "/contact_columns", "/plot/force", "/plot/penetration")


def simulate_elsewhere(
    job: CellJob, began: Callable[[Callable[[], int]], None] | None
) -> tuple[CellOutcome, Written, WorstStates | None]:
    """Simulate a cell by its engine and write its log; returns what `cell.Simulated` has."""
    from .cell import interrupted, plan_in_log

    config, engine = job.config, job.config.engine
    assert engine is not None
    peer = peer_of(engine.name)
    reported = peer.reports(engine.name)
    absent = absent_topics((job.in_log or plan_in_log(job.plan)).absent, peer, reported)
    if "/contacts" in absent:
        reported = ()
    metadata = metadata_of(engine, peer, reported, job.seeds)
    writer = TraceWriter(job.path, config, job.as_written, metadata, absent, job.copy)
    unseen = absent | partly_recorded(described(config.record))
    bodies = list(config.scene.bodies)
    bounds = Bounds(job.always, bodies, config, config.clock, unseen)
    rows = RowsOfStates(config, reported, peer.counted)
    status = "complete"
    done = [0]  # steps; read by who shows the progress, at any time
    build_ns = physics_ns = logging_ns = 0
    compiled = compiled_ns()
    task = Task(config.as_json(), engine.name, dict(engine.settings))
    running = messages_of(task)
    with deferred() as signalled:
        for message in running:
            start = clock_without_compiling()
            if isinstance(message, Built):
                build_ns = message.build_ns
                if began is not None:
                    began(partial(done.__getitem__, 0))
            elif isinstance(message, States):
                kept = message if reported else message._replace(contacts=message.contacts[:0, :3])
                row, moving = first_not_finite(kept)
                block, broken = bounds.within(rows.block(_up_to(kept, row)), row is not None)
                writer.append(block)
                done[0] = int(block.step["step"][-1])
                physics_ns += message.step_ns * len(block.step) // len(message.pose)
                if broken or row is not None:
                    status = broken or divergence(config, moving, done[0])
                    break
            elif message.why:
                status = f"failed: {message.why} after step {done[0]}"
            logging_ns += clock_without_compiling() - start
            if name := signalled():
                status = interrupted(config.clock, name, done[0])
                break
        running.close()
        start = clock_without_compiling()
        written = writer.close(status)
        logging_ns += clock_without_compiling() - start
    accuracy = Accuracy(worst_residual=float("nan"), not_converged=None)
    times = build_ns + compiled_ns() - compiled, physics_ns, logging_ns
    outcome = CellOutcome(job.cell, status, done[0], *times, accuracy, written.digest)
    return outcome, written, bounds.worst


def first_not_finite(states: States) -> tuple[int | None, int]:
    """Return the row and the movable body of the first state with a number that is none."""
    state = np.concatenate([states.pose, states.velocity], axis=2)
    whole: NDArray[np.bool_] = np.isfinite(state).all(axis=2)
    rows = np.flatnonzero(~whole.all(axis=1))
    return (int(rows[0]), int(np.argmin(whole[rows[0]]))) if len(rows) else (None, 0)


def _up_to(states: States, row: int | None) -> States:
    """Return the states up to one, with it."""
    if row is None:
        return states
    end, counts = row + 1, states.iterations
    return states._replace(
        pose=states.pose[:end],
        velocity=states.velocity[:end],
        contacts=states.contacts[states.contacts[:, 0] < states.first + end],
        iterations=None if counts is None else counts[:end],
    )


def divergence(config: CellConfig, moving: int, step: int) -> str:
    """Return one sentence naming the body, the step and the time of the divergence."""
    bodies = config.scene.bodies.items()
    name = [name for name, body in bodies if is_movable(body)][moving]
    time = float(config.clock.time(step))
    return f"diverged: body {name} is no longer finite after step {step} (t = {time:.9g} s)"


def absent_topics(planned: dict[str, str], peer: Peer, reported: tuple[str, ...]) -> dict[str, str]:
    """Return the topics that a log does without: by the plan, and what is not reported."""
    silent = f"{peer.title} {NOT_REPORTED}"
    absent = planned | {"/residuals": silent, "/plot/log10_residual": silent}
    return absent if reported else absent | {topic: absent.get(topic, silent) for topic in CONTACTS}


def metadata_of(
    engine: CellEngine, peer: Peer, reported: tuple[str, ...], seeds: str
) -> dict[str, dict[str, str]]:
    """Return what a log says of the engine that made it, and of the columns that it lacks."""
    version = installed_version(peer.name)
    made_by = {
        "name": engine.name,
        "version": f"{peer.title} {version}",
        "variant": peer.variants[engine.name].doc,
        "settings": ", ".join(f"{name}: {value}" for name, value in engine.settings.items()),
        "law": peer.law,
        "precision": "double" if peer.double else "single",
        "iterations": peer.iterations,
        "capacity": peer.capacity,
        "repeats": peer.repeats,
        "seed": seeds,
    }
    has = {name for name, _ in step_columns(reported, peer.counted)}
    not_reported = {f"/step.{one.name}" for one in STEP_COLUMNS if one.name not in has}
    if reported:
        has = {name for name, _ in contact_columns(reported)}
        not_reported |= {f"/contacts.{name}" for name in CONTACT_COLUMNS if name not in has}
    silent = f"{peer.title} {NOT_REPORTED}"
    return {
        "versions": versions(),
        "engine": made_by,
        NOT_REPORTED_COLUMNS: dict.fromkeys(sorted(not_reported), silent),
    }
