"""What stands in a config and does nothing: surfaces, shapes, constants; a run without a claim."""

from __future__ import annotations

from collections.abc import Iterator

from lavendersim.errors import Defect
from lavendersim.experiment import Experiment, key_mark
from lavendersim.experiment.resolve.formulas import constants_of, used_constants
from lavendersim.experiment.text.node import ABSENT, Node, graft
from lavendersim.quantities.found import quoted


def unused_surfaces(experiment: Experiment) -> Iterator[Defect]:
    """Yield a defect at each named surface whose name stands nowhere else in the file.

    That a pair of surfaces names it gives it to no body.
    """
    surfaces = experiment.tree.get("scene", "surfaces")
    used = set(_without_pairs(experiment.tree).texts) if surfaces.entries else set()
    for name in surfaces.entries:
        if name not in used:
            mark = key_mark(surfaces, name)
            if not mark.file:  # a file that others extend has what each of them may use
                sentence = f"surface {quoted(name)} is that of no body"
                yield mark.defect(str(experiment.path), sentence)


def _without_pairs(tree: Node) -> Node:
    pairs = tree.get("scene", "surface_pairs")
    return graft(tree, ("scene", "surface_pairs"), ABSENT) if pairs else tree


def unused_shapes(experiment: Experiment) -> Iterator[Defect]:
    """Yield a defect at each named shape whose name stands nowhere else in the file."""
    shapes = experiment.tree.get("scene", "shapes")
    used = set(experiment.tree.texts) if shapes.entries else set()
    for name in shapes.entries:
        mark = key_mark(shapes, name)
        if name not in used and not mark.file:
            yield mark.defect(str(experiment.path), f"shape {quoted(name)} is that of no body")


def unused_constants(experiment: Experiment) -> Iterator[Defect]:
    """Yield a defect at each constant that no formula takes."""
    constants = constants_of(experiment.tree)
    used = used_constants(experiment.tree) if constants else set()
    for name, (_, mark) in constants.items():
        if name not in used and not mark.file:
            sentence = f"constant {quoted(name)} is not used; a formula takes it as ${name}"
            yield mark.defect(str(experiment.path), sentence)


def unclaimed(experiment: Experiment) -> Iterator[Defect]:
    """Yield a defect where nothing is claimed of a run, so that its verdict says nothing."""
    config = experiment.config
    if config.expect or config.always or config.cost or config.overhead:
        return
    tree = experiment.tree
    mark = key_mark(tree, "measure") if "measure" in tree.entries else tree.mark
    sentence = "nothing is claimed: without expect or always the run has no verdict"
    yield mark.defect(str(experiment.path), sentence)
