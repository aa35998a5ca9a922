"""What of a cell cannot be together with joints yet, each refused where the file has it."""

from __future__ import annotations

from collections.abc import Iterator

from lavendersim.cell.choices import NO_MISTAKE
from lavendersim.cell.config import CellConfig
from lavendersim.cell.record import NONE
from lavendersim.engine.effects import holding
from lavendersim.experiment.checks.messages import locate
from lavendersim.experiment.text.node import Node, Path, key_mark
from lavendersim.experiment.text.report import Report

# Solvers whose sweeps take rows without a cone.
SOLVERS = ("adaptive", "projected_gauss_seidel")
IMPACTS = ("in_order", "captured")
MOVES = ("teleport", "orientation")  # of an event: at once, whatever joints there are


def refuse_beside_joints(config: CellConfig, tree: Node, report: Report) -> None:
    """Note what of a resolved cell its joints cannot be with; tree: that the cell was made of."""
    if not holding(config.scene):
        return
    for path, sentence in _limits(config):
        parent = tree.get(*path[:-1])
        key = str(path[-1])
        written = key in parent.entries
        mark = key_mark(parent, key) if written else locate(tree, path)[1].mark
        report.add(mark, f"{key}: {sentence}")
    joined = {name for one in holding(config.scene).values() for name in one.between}
    for event in tree.get("events").items:
        name = event.get("body").text
        for key in MOVES:
            if name in joined and key in event.entries:
                sentence = f"{name} has a joint, which this would tear; leave it out"
                report.add(key_mark(event, key), f"{key}: {sentence}")


def _limits(config: CellConfig) -> Iterator[tuple[Path, str]]:
    numerics, joints = config.numerics, "the scene has joints"
    if numerics.solver not in SOLVERS:
        expected = f"{joints}, which {numerics.solver} does not solve; expected {_one_of(SOLVERS)}"
        yield ("numerics", "solver"), expected
    if numerics.impacts not in IMPACTS:
        yield (
            ("numerics", "impacts"),
            f"{joints}, which {numerics.impacts} may tear; expected {_one_of(IMPACTS)}",
        )
    if numerics.impacts == "in_order" and numerics.simultaneous_impacts != "together":
        path = ("numerics", "simultaneous_impacts")
        yield path, f"{joints}, which pass impacts on at once; expected together"
    if numerics.accuracy is not None:
        yield ("numerics", "accuracy"), f"{joints}, and substeps have none; leave it out"
    if numerics.sleeping:
        yield ("numerics", "sleeping"), f"{joints}, and what they hold does not sleep; leave it out"
    if config.scene.springs:
        yield (
            ("scene", "springs"),
            f"{joints}, and a step has one of the two; leave one of them out",
        )
    if config.study.mistake != NO_MISTAKE:
        yield ("study", "mistake"), f"{joints}, which have none; leave it out"
    if config.record.problems != NONE:
        sentence = f"{joints}, and a contact problem has cones alone; leave it out"
        yield ("record", "problems"), sentence


def _one_of(names: tuple[str, ...]) -> str:
    return " or ".join(names)
