"""Which scenes have no depth in closed form, and which no overlap that is looked for."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from lavendersim.experiment import load_experiment_text
from lavendersim.measures.overlap_of_bodies import overlap_of_rows, unknown_overlap

SHAPES = {
    "ball": "{kind: sphere, radius: 1}",
    "box": "{kind: box, size: [1, 1, 1]}",
    "bar": "{kind: cylinder, radius: 1, length: 1}",
    "pill": "{kind: capsule, radius: 1, length: 1}",
    "hull": "{kind: hull, points: [[0,0,0],[1,0,0],[0,1,0],[0,0,1]]}",
}


@pytest.mark.parametrize(
    ("names", "why"),
    [
        (("ball", "box"), ""),
        (("ball", "pill"), ""),
        (("bar",), ""),  # with planes it has one
        (("bar", "ball"), "no closed form for the depth of sphere and cylinder"),
        (("bar", "bar"), "no closed form for the depth of cylinder and cylinder"),
        (("box", "pill"), "no closed form for the depth of box and capsule"),
        (("hull",), "no closed form for the depth of a hull"),
    ],
)
def test_the_first_pair_without_a_closed_form_is_named(names: tuple[str, ...], why: str) -> None:
    bodies = "\n".join(
        f"    b{k}: {{shape: {SHAPES[name]}, mass: 1, position: [{9 * k}, 0, 5]}}"
        for k, name in enumerate(names)
    )
    text = f"scene:\n  bodies:\n    floor: {{shape: {{kind: plane}}}}\n{bodies}\nduration: 1\n"
    config = load_experiment_text(text, "pairs.yaml").cells()[0].config
    assert unknown_overlap(config.scene) == why


def test_across_the_faces_of_a_periodic_cell_no_overlap_is_looked_for() -> None:
    """Balls of 0.1 m at 0.05 and 1.95 m of a cell of 2 m: 0.1 m deep, and 1.7 m apart."""
    ball = "{shape: {kind: sphere, radius: 0.1}, mass: 1, position: [%s, 0, 0]}"
    bodies = "\n".join(f"    b{k}: {ball % x}" for k, x in enumerate((0.05, 1.95)))
    text = f"scene:\n  gravity: 0\n  periodic: {{x: [0, 2]}}\n  bodies:\n{bodies}\nduration: 1\n"
    trace = SimpleNamespace(config=load_experiment_text(text, "cell.yaml").cells()[0].config)
    assert np.isnan(overlap_of_rows(trace, [0, 1])).all()  # type: ignore[arg-type]
