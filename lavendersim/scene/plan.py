"""The plan: which effects the engine of a scene is composed of, and why each is in or left out."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final, NamedTuple

from lavendersim.cell import CellConfig, CellEffects, Numerics
from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.effects import EFFECTS, Decision, Facts
from lavendersim.engine.effects.decision import named
from lavendersim.engine.effects.least_norm import is_affordable
from lavendersim.engine.spec import Spec
from lavendersim.errors import ConfigError, UsageError
from lavendersim.experiment.cell import Cell

from .facts import facts_of
from .numbers_read import NumbersRead
from .overrides import Forced, OverrideError, override

# What cells of one engine agree in. Numerics that choose between laws: no coefficient turns one
# engine into another's; what the section `study` asks for is one more. Effects switched by hand: a
# union would undo what they leave out.
CHOICES: Final = (
    "solver",
    "speculative",
    "impacts",
    "simultaneous_impacts",
    "integrator",
    "compliance_law",
    "undetermined_forces",
    "error_control",
    "friction_cone",
    "order",
    "sleeping",
    "mistake",
    "effects",
    "engine",
)
_NUMERICS: Final = frozenset(Numerics.model_fields)
APART: Final = {
    name: Decision(False, f"no {pair.shapes[0]} and {pair.shapes[1]} may touch")
    for name, pair in SHAPE_PAIRS.items()
}
AS_SOLVED: Final = "as_solved"
DERIVED: Final = "derived"  # no effect is switched by hand
MOST_LABELS: Final = 4  # of cells in a sentence


class CellName(NamedTuple):
    """A cell of a sweep: its place and its label; a scene alone is cell 0 without a label.

    In order they stand as the cells do.
    """

    number: int = 0
    label: str = ""

    @property
    def text(self) -> str:
        """Its name in a sentence."""
        return self.label or str(self.number)


CellNames = tuple[CellName, ...]
Reasons = dict[str, CellNames]  # reason -> cells
ALONE: Final = CellName()


class Plan(NamedTuple):
    """The structure of the engine for a scene, or for cells that share it, and why."""

    spec: Spec
    decisions: dict[str, Decision]  # of every effect
    choices: tuple[Any, ...]  # the values of CHOICES; cells that differ share no engine
    shape_pairs: dict[str, Decision]  # of every pair of shapes
    forced: dict[str, Forced]  # what was switched against the scene
    cells: tuple[CellName, ...]  # that this is the plan of
    required_by: dict[str, tuple[CellName, ...]]  # see `requiring`; no key: none
    reasons: dict[str, Reasons]  # of a union: see `reasons_of`

    @property
    def engine(self) -> str:
        """The engine of its cells; another than lavender's composes nothing of it."""
        return str(self.choices[CHOICES.index("engine")])

    def decided(self, name: str) -> Decision:
        """Return the decision on an effect or a shape pair."""
        return self.decisions[name] if name in self.decisions else self.shape_pairs[name]

    def reasons_of(self, name: str) -> Reasons:
        """Return every reason for the decision on an effect or pair, and the cells it holds in."""
        return self.reasons.get(name) or {self.decided(name).reason: self.cells}

    def described(self, name: str) -> str:
        """Return the reason in one line, with the cells that it holds for."""
        reason, requirement = self.decided(name).reason, self.requirement(name)
        return f"{reason}; {requirement}" if requirement else reason

    def requiring(self, name: str) -> tuple[CellName, ...]:
        """Return which cells require an effect or pair."""
        return self.required_by.get(name, ())

    def of(self, cells: tuple[CellName, ...]) -> Plan:
        """Return the plan of one cell as that of all that are decided alike."""
        required = dict.fromkeys(self.required_by, cells)
        return self._replace(cells=cells, required_by=required)

    def requirement(self, name: str) -> str:
        """Return which cells require an effect or pair, where it is some of them and not all."""
        requiring = self.requiring(name)
        if not 0 < len(requiring) < len(self.cells):
            return ""
        labels = [cell.text for cell in requiring]
        if len(labels) > MOST_LABELS:
            labels = [*labels[: MOST_LABELS - 1], f"{len(labels) - MOST_LABELS + 1} more"]
        return f"required by {len(requiring)} of {len(self.cells)} cells: {'; '.join(labels)}"


def plan_of(
    config: CellConfig,
    record: bool = True,
    cell: CellName = ALONE,
    read: NumbersRead | None = None,
) -> Plan:
    """Derive the plan of one cell from its config alone.

    record: its steps are to be logged. read: notes which numbers of bodies it depends on.
    Raises OverrideError where its `effects` cannot be.
    """
    facts = facts_of(config, record)
    if read is not None:
        facts = read.watched(facts)
    derived = {effect.name: effect.decide(facts) for effect in EFFECTS}
    touching = _shape_pairs(facts)
    made = override(derived, touching, facts, config.effects)
    numerics = config.numerics
    spec = Spec(
        effects=_on(made.effects),
        shape_pairs=_on(made.shape_pairs),
        solver=numerics.solver,
        tolerance=numerics.tolerance is not None,
        friction_cone=numerics.friction_cone,
        over_relaxation=numerics.over_relaxation != 1.0,
        order=numerics.order,
    )
    required = [name for name, decision in (derived | touching).items() if decision.on]
    return Plan(
        spec,
        made.effects,
        _choices(config, facts),
        made.shape_pairs,
        made.forced,
        (cell,),
        dict.fromkeys(required, (cell,)),
        {},
    )


def plan_of_cell(cell: Cell, record: bool = True, read: NumbersRead | None = None) -> Plan:
    """Derive the plan of a cell; raises ConfigError at the keys of its `effects` that cannot be."""
    try:
        return plan_of(cell.config, record, name_of(cell), read)
    except OverrideError as error:
        defects = [cell.defect(("effects", one.name), one.sentence) for one in error.refusals]
        raise ConfigError(sorted(defects)) from None  # in the order of the file


def name_of(cell: Cell) -> CellName:
    """Return what sentences call a cell."""
    return CellName(cell.index, cell.label)


def union(plans: Iterable[Plan]) -> Plan:
    """Return the plan for every cell of a sweep: an effect is on where any cell requires it."""
    plans = list(plans)
    first = plans[0]
    for name, *values in zip(CHOICES, *(plan.choices for plan in plans), strict=True):
        if len(set(values)) > 1:
            raise UsageError(f"the cells of one sweep share their {name}")
    if len(plans) == 1:
        return first
    names = (*first.decisions, *first.shape_pairs)
    cells = tuple(sorted(cell for plan in plans for cell in plan.cells))
    reasons = {name: _reasons(plans, name, cells) for name in names}
    joined = {name: _joined(plans, name, reasons[name]) for name in names}
    effects = {name: joined[name] for name in first.decisions}
    shape_pairs = {name: joined[name] for name in first.shape_pairs}
    spec = first.spec._replace(
        effects=_on(effects),
        shape_pairs=_on(shape_pairs),
        tolerance=any(plan.spec.tolerance for plan in plans),
        over_relaxation=any(plan.spec.over_relaxation for plan in plans),
    )
    required_by = {name: _together([one.requiring(name) for one in plans], cells) for name in names}
    forced = {name: how for plan in plans for name, how in plan.forced.items()}
    for name, how in list(forced.items()):
        if how == "forced on" and required_by[name]:
            del forced[name]  # on without being forced, for the cells that require it
    return Plan(spec, effects, first.choices, shape_pairs, forced, cells, required_by, reasons)


def _together(parts: Sequence[CellNames], every: CellNames) -> CellNames:
    """Return the cells of some plans in their order; every: those of all plans, kept once."""
    if sum(map(len, parts)) == len(every):
        return every
    return tuple(sorted(itertools.chain.from_iterable(parts)))


def _joined(plans: list[Plan], name: str, reasons: Reasons) -> Decision:
    """Return the decision of a union, whose reason names its cell where they differ."""
    on = any(plan.decided(name).on for plan in plans)
    first, cells = next(iter(reasons.items()))
    if len(reasons) == 1:
        return Decision(on, first)
    more = "1 other reason" if len(reasons) == 2 else f"{len(reasons) - 1} other reasons"
    return Decision(on, f"{first} (cell {cells[0].text}; {more} in other cells)")


def _reasons(plans: list[Plan], name: str, every: CellNames) -> Reasons:
    """Return why an effect is on, where it is in any cell, else why off: rather required than
    forced on, rather forced off than not required.
    """
    on = any(plan.decided(name).on for plan in plans)
    agreeing = [plan for plan in plans if plan.decided(name).on == on]
    deciding = [plan for plan in agreeing if (name in plan.forced) != on]
    reasons: dict[str, list[CellNames]] = {}
    for plan in deciding or agreeing:
        reasons.setdefault(plan.decided(name).reason, []).append(plan.cells)
    return {reason: _together(parts, every) for reason, parts in reasons.items()}


def _on(decisions: Mapping[str, Decision]) -> tuple[str, ...]:
    return tuple(sorted(name for name, decision in decisions.items() if decision.on))


def _choices(config: CellConfig, facts: Facts) -> tuple[Any, ...]:
    numerics, study = config.numerics, config.study
    made = {
        "error_control": numerics.accuracy is not None,
        # Where many bodies move, they are as solved: an engine of few would choose theirs.
        "undetermined_forces": numerics.undetermined_forces if is_affordable(facts) else AS_SOLVED,
        "effects": _switched(config.effects),
        "engine": "lavender" if config.engine is None else config.engine.name,
    }
    return tuple(
        made[name] if name in made else getattr(numerics if name in _NUMERICS else study, name)
        for name in CHOICES
    )


def _switched(effects: CellEffects) -> str:
    """Return what is switched by hand, as the file has it."""
    return ", ".join(f"{name}: {how}" for name, how in effects.switches.items()) or DERIVED


def _shape_pairs(facts: Facts) -> dict[str, Decision]:
    """Return of every pair of shapes whether two such bodies may touch, and which."""
    touching: dict[str, list[str]] = {}
    for pair in facts.pairs:
        more = f" ({pair.row_pairs} pairs like it)" if pair.row_pairs > 1 else ""
        touching.setdefault(pair.shape_pair, []).append(f"{pair.a} and {pair.b}{more}")
    return {
        name: Decision(True, named(touching[name])) if name in touching else APART[name]
        for name in SHAPE_PAIRS
    }
