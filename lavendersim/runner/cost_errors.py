"""The error of each setting of a cost grid: of the timestep, of the solver and of the model.

Three errors stand apart, none hides another:
    timestep   |measure - truth| / scale, and the order p of error ~ timestep^p between neighbours
    solver     the worst residual of any step [m/s]
    model      which law is solved: the cone, where restitution acts, rigid or compliant
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from lavendersim.cell import CellConfig
from lavendersim.errors import is_not_reported
from lavendersim.experiment import Experiment
from lavendersim.experiment.sweeps.cost_grid import Setting
from lavendersim.experiment.sweeps.perturbed_starts import spread_of, start_of
from lavendersim.measures import Values, judge
from lavendersim.measures.closed_forms import evaluate_form
from lavendersim.measures.specs.base import ClosedForm
from lavendersim.peers.catalogue import peer_of
from lavendersim.scene.classes import class_pairs
from lavendersim.scene.colliders import colliders

from .cell_outcome import CellOutcome
from .cost_targets import ROUND_OFF
from .run_directory import RunCell
from .step_counts import StepCounts, counts_of

if TYPE_CHECKING:
    from .experiment_run import Finished

NAN = float("nan")
CONES = {
    "disc": "Coulomb's cone",
    "pyramid": "a pyramid of friction",
    "convex": "the convex relaxation of Coulomb's law",
}
IMPACTS = {
    "captured": "at the step's start",
    "at_surface": "at the surface",
    "in_order": "at the surface, in order",
}
INTEGRATORS = {
    "midpoint_contact": "midpoint rule, contacts included",
    "midpoint": "midpoint rule",
    "semi_implicit_euler": "semi-implicit Euler",
}


class SettingRun(NamedTuple):
    """The cells of one setting, one for each cell of the experiment's own sweep."""

    setting: Setting
    cells: Sequence[RunCell]
    outcomes: Sequence[CellOutcome]
    measured: Sequence[Mapping[str, Any]]


class SettingError(NamedTuple):
    """How wrong a setting is."""

    error: float  # relative, of the worst cell; NaN where there is none
    least: float | None  # over perturbed starts, of each the worst cell; None: they are not swept
    worst_at: str  # the coordinates of that cell; "" without a sweep
    residual: float  # [m/s] the worst of any step of any cell
    not_converged: int  # steps above the tolerance asked for
    steps: int  # of all cells
    failed: str  # why the setting is no answer; "" where it is one
    counts: StepCounts = StepCounts()


def runs_of(
    settings: Sequence[Setting], finished: Finished, measured: Sequence[Mapping[str, Any]]
) -> list[SettingRun]:
    """Return the cells of every setting: they follow each other in the sweep."""
    cells = finished.run.cells
    each = len(cells) // len(settings)
    return [
        SettingRun(setting, cells[begin:end], finished.outcomes[begin:end], measured[begin:end])
        for setting, begin, end in (
            (setting, place * each, (place + 1) * each) for place, setting in enumerate(settings)
        )
    ]


def errors_of(experiment: Experiment, runs: Sequence[SettingRun]) -> list[SettingError]:
    """Return how wrong each setting is."""
    truth = next((run for run in runs if run.setting.role == "truth"), None)
    return [_error_of(experiment, run, truth) for run in runs]


def _error_of(experiment: Experiment, run: SettingRun, truth: SettingRun | None) -> SettingError:
    labels = [cell.label for cell in experiment.cells()]
    found = [_cell_error(experiment, run, place, truth) for place in range(len(run.cells))]
    taken = [place for place, error in enumerate(found) if error is not None]
    errors = [NAN if (error := found[place]) is None else error for place in taken]
    # NaN first: a cell without an answer is worse than any other
    worst = int(np.argmax([math.inf if math.isnan(error) else error for error in errors] or [0]))
    return SettingError(
        error=errors[worst] if errors else NAN,
        least=_least(experiment, taken, errors),
        worst_at=labels[taken[worst]] if errors else "",
        residual=max(outcome.accuracy.worst_residual for outcome in run.outcomes),
        not_converged=sum(outcome.accuracy.not_converged or 0 for outcome in run.outcomes),
        steps=sum(outcome.steps for outcome in run.outcomes),
        failed=_failure(experiment, run, errors),
        counts=counts_of(run.cells),
    )


def _least(experiment: Experiment, taken: list[int], errors: list[float]) -> float | None:
    """Return the least error of any start; None where one has none, or they are not swept."""
    cells, worst = experiment.cells(), dict[int, float]()
    for place, error in zip(taken, errors, strict=True):
        if (seed := start_of(cells[place].coordinates)) is not None:
            worst[seed] = max(error, worst.get(seed, 0.0)) if error == error else math.inf
    spread = spread_of(worst)
    return spread[0] if spread is not None and math.isfinite(spread[0]) else None


def _cell_error(
    experiment: Experiment, run: SettingRun, place: int, truth: SettingRun | None
) -> float | None:
    """Return the relative error of one cell; None where the measure is not taken, NaN without."""
    assert experiment.config.cost is not None
    spec = experiment.config.cost.error
    value = run.measured[place].get(spec.measure)
    if value is None:
        return None
    true: Any = spec.truth
    if truth is not None:
        true = truth.measured[place].get(spec.measure)
    elif isinstance(true, ClosedForm):
        true = evaluate_form(true, run.cells[place].trace().config)
    if isinstance(value, str) or isinstance(true, str):
        return NAN  # the log could not answer
    return relative_error(value, true, spec.scale)


def relative_error(value: Any, truth: Any, scale: float | None) -> float:
    """Return the largest |value - truth| / scale; NaN where rows differ in length.

    scale: the largest |truth| where it is None, and 1 where that is 0.
    """
    row, true = np.atleast_1d(value).astype(float), np.atleast_1d(truth).astype(float)
    if len(true) not in (1, len(row)):
        return NAN
    whole = scale if scale is not None else float(np.max(np.abs(true))) or 1.0
    return float(np.max(np.abs(row - true)) / whole)


def _failure(experiment: Experiment, run: SettingRun, errors: Sequence[float]) -> str:
    """Say why a setting is no answer, whatever its error: the first reason there is."""
    for cell, outcome in zip(experiment.cells(), run.outcomes, strict=True):
        if outcome.status != "complete":
            return f"{cell.label}: {outcome.status}" if cell.label else outcome.status
    assert experiment.config.cost is not None
    not_converged = sum(outcome.accuracy.not_converged or 0 for outcome in run.outcomes)
    steps = sum(outcome.steps for outcome in run.outcomes)
    if not_converged > experiment.config.cost.not_converged * steps:
        return not_converged_steps(not_converged, steps, run.setting.tolerance)
    if not errors or any(math.isnan(error) for error in errors):
        return "its log has no answer"
    unmet = _unmet(experiment, run)
    return f"not met: {unmet[0]}" if unmet else ""


def not_converged_steps(not_converged: int, steps: int, tolerance: float | None) -> str:
    """Say how many steps ended above the tolerance they asked for."""
    return f"{not_converged} of {steps} steps above {tolerance:g} m/s"


def _taken(experiment: Experiment, measured: Mapping[str, Any]) -> dict[str, Any]:
    """Return every measure of a cell; NaN where the log had no answer, its reason where an engine
    does not report what it takes: such a claim is not judged.
    """
    values = {name: measured.get(name, NAN) for name in experiment.measures}
    return {
        name: NAN if isinstance(one, str) and not is_not_reported(one) else one
        for name, one in values.items()
    }


def _unmet(experiment: Experiment, run: SettingRun) -> list[str]:
    """Return the claims a setting does not keep, but for those on the error itself."""
    assert experiment.config.cost is not None
    error = experiment.config.cost.error.measure
    claims = [each for each in experiment.expectations if each.measure != error]
    # as the experiment's expectations know them: without the axes of the grid
    own = [
        replace(inside, index=place, label=cell.label, coordinates=cell.coordinates)
        for place, (cell, inside) in enumerate(zip(experiment.cells(), run.cells, strict=True))
    ]
    taken = {place: _taken(experiment, one) for place, one in enumerate(run.measured)}
    verdicts = judge(experiment.measures, claims, own, Values(experiment.measures, taken))
    for cell in run.cells:
        cell.release()
    return [verdict.node for verdict in verdicts if verdict.fails]


def orders_of(settings: Sequence[Setting], errors: Sequence[float]) -> list[float | None]:
    """Return the observed order of each setting against the next coarser timestep of its curve."""
    places: dict[tuple[Any, ...], list[int]] = {}
    for place, setting in enumerate(settings):
        if setting.role != "truth":
            places.setdefault(setting.curve, []).append(place)
    orders: list[float | None] = [None] * len(settings)
    for curve in places.values():
        curve.sort(key=lambda place: -settings[place].timestep)
        for coarse, fine in pairwise(curve):
            ratio = float(settings[coarse].timestep / settings[fine].timestep)
            # false for NaN; what is left of an error at round-off has no order
            if min(errors[coarse], errors[fine]) > ROUND_OFF:
                orders[fine] = math.log(errors[coarse] / errors[fine]) / math.log(ratio)
    return orders


def law_of(config: CellConfig) -> str:
    """Name the law whose problem is solved: what no timestep and no sweep can improve."""
    if config.engine is not None:
        return peer_of(config.engine.name).law
    numerics = config.numerics
    surfaces = [pair.surface for pair in class_pairs(colliders([*config.scene.bodies.values()]))]
    compliant = any(one.compliance or one.hertz_stiffness for one in surfaces)
    laws = ["compliant contacts" if compliant else "rigid contacts"]
    if any(surface.friction for surface in surfaces):
        laws.append(CONES.get(numerics.friction_cone, numerics.friction_cone))
    if any(surface.restitution for surface in surfaces):
        laws.append(f"restitution {IMPACTS.get(numerics.impacts, numerics.impacts)}")
    laws.append(INTEGRATORS.get(numerics.integrator, numerics.integrator))
    return ", ".join(laws)
