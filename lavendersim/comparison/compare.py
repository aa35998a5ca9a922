"""The comparison of two finished runs."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any, Final, NamedTuple

from lavendersim.comparison.pairing import CellPair, Pairing, paired
from lavendersim.comparison.states import NOTHING, Parting, parting
from lavendersim.comparison.trees import ABSENT, Difference, differences, equal
from lavendersim.errors import TraceError
from lavendersim.runner import Run
from lavendersim.runner.environment import PACKAGES
from lavendersim.runner.json_table import finite
from lavendersim.runner.run_directory import ENVIRONMENT
from lavendersim.runner.run_results import RunResults
from lavendersim.runner.run_seal import read_sealed

VERSIONS: Final = ("lavender", "engine source", "python", *PACKAGES)
MACHINE: Final = ("system", "processor", "cores")
COSTS: Final = ("physics_us_per_step", "logging_us_per_step")


class MeasureChange(NamedTuple):
    """A measure of a pair of cells that differs; a text is why there is no number."""

    cell: str
    name: str
    a: Any
    b: Any


class VerdictChange(NamedTuple):
    """A claim that is judged otherwise, or by one run alone."""

    node: str
    a: str
    b: str


class CellStates(NamedTuple):
    """Where the states of a pair of cells part."""

    cell: str
    parting: Parting
    statuses: tuple[str, str]


class Comparison(NamedTuple):
    """What differs between two runs."""

    a: Run
    b: Run
    config: list[Difference]  # as written
    resolved: list[tuple[Difference, int]]  # of cells, beside that; in how many pairs
    versions: list[Difference]
    machine: list[Difference]
    not_understood: list[str]  # a sentence on each config of another version
    pairing: Pairing
    measures: list[MeasureChange]
    verdicts: list[VerdictChange]
    costs: dict[str, tuple[float, float]]  # mean over all steps
    states: list[CellStates]

    @property
    def equal(self) -> bool:
        """Whether nothing differs but the machine and what steps cost."""
        found = (
            *(self.config, self.resolved, self.versions, self.measures, self.verdicts),
            *(self.pairing.only_a, self.pairing.only_b),
        )
        return not any(found) and not any(map(differs, self.states))

    def table(self) -> dict[str, Any]:
        """Return it as plain data; a number that JSON does not have is a text."""
        table = {
            "a": str(self.a.path),
            "b": str(self.b.path),
            "equal": self.equal,
            "config": [one._asdict() for one in self.config],
            "resolved": [{**one._asdict(), "cells": n} for one, n in self.resolved],
            "versions": [one._asdict() for one in self.versions],
            "machine": [one._asdict() for one in self.machine],
            "not_understood": self.not_understood,
            "paired_by": list(self.pairing.axes),
            "pairs": len(self.pairing.pairs),
            "only_a": self.pairing.only_a,
            "only_b": self.pairing.only_b,
            "measures": [one._asdict() for one in self.measures],
            "verdicts": [one._asdict() for one in self.verdicts],
            "costs": {name: {"a": a, "b": b} for name, (a, b) in self.costs.items()},
            "states": [_state(one) for one in self.states],
        }
        plain: dict[str, Any] = json.loads(json.dumps(table, default=str))
        return dict(finite(plain, str))


def compare(a: Run, b: Run) -> Comparison:
    """Compare two finished runs. UsageError where one is not, TraceError where one is damaged.

    A config that this version does not understand is compared as it was written.
    """
    results = a.results(), b.results()
    pairing = paired(a.cells, b.cells)
    written = list(differences(_written(a), _written(b)))
    known = {one.path for one in written}
    resolved: dict[str, tuple[Difference, int]] = {}
    states: list[CellStates] = []
    for pair in pairing.pairs:
        configs = [cell.trace().config_data() for cell in (pair.a, pair.b)]
        for one in differences(configs[0], configs[1]):
            if one.path not in known:
                first, count = resolved.get(one.path, (one, 0))
                resolved[one.path] = first, count + 1
        states.append(_states_of(pair))
        pair.a.release()
        pair.b.release()
    environments = _environment(a), _environment(b)
    costs = {name: [one.mean_per_step(name) for one in results] for name in COSTS}
    return Comparison(
        a,
        b,
        written,
        list(resolved.values()),
        _named(environments, VERSIONS),
        _named(environments, MACHINE),
        list(dict.fromkeys(run.not_understood for run in (a, b) if run.not_understood)),
        pairing,
        _measures(pairing, results),
        _verdicts(*results),
        {name: (means[0], means[1]) for name, means in costs.items()},
        states,
    )


def differs(one: CellStates) -> bool:
    """Whether the states of a pair part, or its cells ended otherwise."""
    return one.parting.differs != NOTHING or one.statuses[0] != one.statuses[1]


def _states_of(pair: CellPair) -> CellStates:
    """Return where a pair parts; logs that are the same bytes are not read for it."""
    statuses = pair.a.status, pair.b.status
    traces = pair.a.trace(), pair.b.trace()
    written = [cell.expected.digest if cell.expected else None for cell in (pair.a, pair.b)]
    whole = not any(trace.damage for trace in traces)
    if whole and written[0] is not None and written[0] == written[1]:
        return CellStates(pair.label, Parting(NOTHING, len(traces[0].step)), statuses)
    return CellStates(pair.label, parting(*traces), statuses)


def _written(run: Run) -> dict[str, Any]:
    """Return the config as it was read, with what the command line made of it."""
    options = {"--solver": run.options.solver, "reduced": run.options.reduced}
    return {**run.config_data, **{name: one for name, one in options.items() if one}}


def _environment(run: Run) -> dict[str, Any]:
    try:
        table = json.loads(read_sealed(run.path / ENVIRONMENT))
    except (ValueError, RecursionError) as error:
        raise TraceError(f"{run.path / ENVIRONMENT}: damaged: {error}") from None
    return dict(table) if isinstance(table, dict) else {}


def _named(trees: tuple[Mapping[str, Any], ...], names: tuple[str, ...]) -> list[Difference]:
    a, b = ({name: tree.get(name, ABSENT) for name in names} for tree in trees)
    return list(differences(a, b))


def _measures(pairing: Pairing, results: tuple[RunResults, RunResults]) -> list[MeasureChange]:
    rows = [{row.index: row.measures for row in one.cells} for one in results]
    changes = []
    for pair in pairing.pairs:
        mine, others = rows[0][pair.a.index], rows[1][pair.b.index]
        for name in dict.fromkeys((*mine, *others)):
            ends = mine.get(name, ABSENT), others.get(name, ABSENT)
            # Why there is no number names the log, which is another file in another run.
            reasons = all(isinstance(end, str) and end != ABSENT for end in ends)
            if not reasons and not equal(*ends):
                changes.append(MeasureChange(pair.label, name, *ends))
    return changes


def _verdicts(a: RunResults, b: RunResults) -> list[VerdictChange]:
    words = {True: "pass", False: "FAIL", None: ABSENT}
    mine, others = ({one.node: one.passed for one in run.checks} for run in (a, b))
    return [
        VerdictChange(node, words[mine.get(node)], words[others.get(node)])
        for node in dict.fromkeys((*mine, *others))
        if mine.get(node) != others.get(node)
    ]


def _state(one: CellStates) -> dict[str, Any]:
    found = one.parting._asdict()
    found["bodies"] = [body._asdict() for body in one.parting.bodies]
    if one.parting.farthest is not None:
        found["farthest"] = one.parting.farthest._asdict()
    return {"cell": one.cell, "statuses": one.statuses, **found}
