"""A plan explained as data: reasons, record fields, log columns and kernels of every effect.

What an effect brings is read from its own module and from what the engine is composed of with it
and without it. Nothing is compiled.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.composition import composition_of, kept
from lavendersim.engine.effects import EFFECTS, Effect
from lavendersim.engine.effects.packed_sweeps import SHARED_COLOUR, SHARED_SWEEP
from lavendersim.engine.spec import Spec

from .laws import needs
from .plan import CHOICES, Plan

_GLUE = "compile"  # links between the kernels of one stage, of no interest here

Fields = dict[str, list[str]]  # record -> names of its columns
Kernels = dict[str, list[str]]  # module of the engine -> names


class ExplanationItem(NamedTuple):
    """One effect, shape pair or solver: is it in, why, and what it brings."""

    name: str
    on: bool
    reason: str
    reasons: dict[str, list[int]]  # every reason, and the cells it holds in
    forced: str | None  # `forced on` or `forced off`, against what the scene requires
    required_by: list[int]  # cells, by their place in the sweep
    requirement: str  # in words, where some cells require it and others do not
    needs: list[str]  # effects without which it cannot be
    chosen_by: str | None  # key of the numerics, or of the study
    fields: Fields  # of records that it brings, and of log rows
    channels: list[str]  # of the log
    kernels: Kernels  # that are there because of it; none where it is off


class Explanation(NamedTuple):
    """A plan with its reasons."""

    title: str  # how it differs from the other plans of the same sweep, and how many cells it has
    digest: str  # of the spec
    spec: dict[str, Any]
    choices: dict[str, Any]  # what the cells that share it agree in
    cells: list[dict[str, Any]]  # that share it: `index` and `label`
    effects: list[ExplanationItem]  # in the engine's order
    shape_pairs: list[ExplanationItem]
    solver: ExplanationItem
    always: Kernels  # that an engine has without any effect, and none of the above brings
    shared: Kernels  # that several of the above bring together
    threads: str  # what `--threads` would share, or why nothing

    def parts(self) -> list[ExplanationItem]:
        """Return everything that is in or out."""
        return [*self.effects, *self.shape_pairs, self.solver]

    def as_data(self) -> dict[str, Any]:
        """Return it as plain data, effects and pairs by name."""
        data = self._asdict()
        for group in ("effects", "shape_pairs"):
            data[group] = {part.name: part._asdict() for part in data[group]}
        data["solver"] = self.solver._asdict()
        return data


def explain(plan: Plan, others: Iterable[Plan] = ()) -> Explanation:
    """Explain a plan; its title distinguishes it from `others`, those of the same sweep."""
    with kept(plan.spec):
        return _explained(plan, others)


def _explained(plan: Plan, others: Iterable[Plan]) -> Explanation:
    spec, choices = plan.spec, dict(zip(CHOICES, plan.choices, strict=True))
    composed = composed_kernels(spec)
    effects = [_effect(plan, effect) for effect in EFFECTS]
    pairs = [_shape_pair(plan, name) for name in SHAPE_PAIRS]
    bare = Spec(solver=spec.solver, shape_pairs=spec.shape_pairs)
    always = _common(composed, composed_kernels(bare))
    brought = [part.kernels for part in (*effects, *pairs)]
    solver = _solver(plan, _without(composed, *brought))
    always = _without(always, solver.kernels, *brought)
    return Explanation(
        title=title_of(plan, others),
        digest=spec.digest(),
        spec=spec._asdict(),
        choices=choices,
        cells=[{"index": cell.number, "label": cell.label} for cell in plan.cells],
        effects=effects,
        shape_pairs=pairs,
        solver=solver,
        always=always,
        shared=_without(composed, always, solver.kernels, *brought),
        threads=_threads(plan),
    )


def _threads(plan: Plan) -> str:
    solver = plan.spec.solver
    colours = f"colours of {SHARED_COLOUR} contacts and more hold {SHARED_SWEEP} together"
    packed = _decided(plan, "packed_sweeps")
    if packed.on:
        return f"sweeps are shared where {colours}"
    if solver == "coloured_gauss_seidel":
        return f"sweeps are shared where contacts are packed by eight and {colours}"
    if solver == "adaptive":
        return f"nothing is shared: {packed.reason}"
    return f"nothing is shared: the solver is {solver}, and packs no contacts by eight"


def explain_all(plans: Iterable[Plan]) -> list[Explanation]:
    """Explain the different plans of one sweep."""
    plans = list(plans)
    return [explain(plan, plans) for plan in plans]


def _effect(plan: Plan, effect: Effect) -> ExplanationItem:
    part = _decided(plan, effect.name)
    # Some columns depend on what else is there; that is known where the effect is on.
    fields = effect.columns_by_record(plan.spec if part.on else None)
    return part._replace(
        needs=list(effect.needs),
        chosen_by=effect.chosen_by.key if effect.chosen_by else None,
        fields=dict(sorted(fields.items())),
        channels=list(effect.channels or ()),
        kernels=_brought(plan.spec, effect) if part.on else {},
    )


def _decided(plan: Plan, name: str) -> ExplanationItem:
    """Return the decision on an effect or shape pair, before what that brings."""
    decision, reasons = plan.decided(name), plan.reasons_of(name)
    return ExplanationItem(
        name=name,
        on=decision.on,
        reason=decision.reason,
        reasons={why: [cell.number for cell in cells] for why, cells in reasons.items()},
        forced=plan.forced.get(name),
        required_by=[cell.number for cell in plan.requiring(name)],
        requirement=plan.requirement(name),
        needs=[],
        chosen_by=None,
        fields={},
        channels=[],
        kernels={},
    )


def _brought(spec: Spec, effect: Effect) -> Kernels:
    """Return the kernels that are there because of an effect: its own, those that vanish without.

    A kernel of another effect's module is that effect's, whatever else it waits for.
    """
    own = f"effects.{effect.name}"
    dependents = [e.name for e in EFFECTS if spec.has(e.name) and effect.name in needs(e.name)]
    lean = spec.without(*dependents)
    gone = _without(composed_kernels(lean), composed_kernels(lean.without(effect.name)))
    composed = composed_kernels(spec)
    # Without its dependents an engine may have kernels that those make needless.
    gone = _common(gone, composed)
    gone = {module: names for module, names in gone.items() if not _of_an_effect(module)}
    kept = composed.get(own)
    return ({own: kept} if kept else {}) | gone


def _of_an_effect(module: str) -> bool:
    return module.startswith("effects.")


def _shape_pair(plan: Plan, name: str) -> ExplanationItem:
    part = _decided(plan, name)
    if part.on:
        others = tuple(pair for pair in plan.spec.shape_pairs if pair != name)
        # An engine in which nothing touches lacks more than the pair: compared with another one.
        lean = others or tuple(pair for pair in SHAPE_PAIRS if pair != name)[:1]
        without = composed_kernels(plan.spec._replace(shape_pairs=lean))
        part = part._replace(kernels=_without(composed_kernels(plan.spec), without))
    return part


def _solver(plan: Plan, composed: Kernels) -> ExplanationItem:
    spec = plan.spec
    columns = list(dict.fromkeys(composition_of(spec).solver_columns))
    fields = {"contact": columns} if columns else {}
    stops = "stops at a tolerance" if spec.tolerance else "takes all its sweeps"
    return ExplanationItem(
        name=spec.solver,
        on=True,
        reason=f"numerics.solver is {spec.solver}; it {stops}",
        reasons={},
        forced=None,
        required_by=[cell.number for cell in plan.cells],
        requirement="",
        needs=[],
        chosen_by="solver",
        fields=fields,
        channels=[],
        kernels={m: names for m, names in composed.items() if m.startswith("solvers.")},
    )


def title_of(plan: Plan, others: Iterable[Plan]) -> str:
    """Return the choices in which plans of one sweep differ, and how many cells share this one."""
    others = list(others)
    differing = [
        f"{name}: {value}"
        for place, (name, value) in enumerate(zip(CHOICES, plan.choices, strict=True))
        if len({other.choices[place] for other in others}) > 1
    ]
    count = len(plan.cells)
    cells = f"{count} cells" if count > 1 else plan.cells[0].label or "1 cell"
    return f"{', '.join(differing)} ({cells})" if differing else cells


def composed_kernels(spec: Spec) -> Kernels:
    """Return the kernels that an engine is composed of, without the links between them."""
    composed = composition_of(spec).kernels
    return {module: list(names) for module, names in composed.items() if module != _GLUE}


def _without(kernels: Kernels, *others: Mapping[str, list[str]]) -> Kernels:
    """Return the kernels that none of the others has."""
    left = {
        module: [name for name in names if not any(name in o.get(module, ()) for o in others)]
        for module, names in kernels.items()
    }
    return {module: names for module, names in left.items() if names}


def _common(kernels: Kernels, others: Kernels) -> Kernels:
    """Return the kernels that both have."""
    return _without(kernels, _without(kernels, others))
