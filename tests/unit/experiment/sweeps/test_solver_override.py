"""A solver put in the place of the config's."""

from __future__ import annotations

import pytest

from lavendersim.experiment import load_experiment_text

SCENE = """\
scene:
  bodies:
    floor: {shape: {kind: plane}}
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, position: [0, 0, 0.1]}
duration: 0.1
"""


@pytest.mark.parametrize(
    "numerics", ["", "numerics: default\n", "numerics: chapter\n", "numerics: {sweeps: 7}\n"]
)
def test_only_the_solver_is_another(numerics: str) -> None:
    text = SCENE + numerics
    own = load_experiment_text(text, "case.yaml").cells()[0].config.as_dict()
    (cell,) = load_experiment_text(text, "case.yaml", solver="jacobi").cells()
    assert own["numerics"]["solver"] != "jacobi"
    own["numerics"]["solver"] = "jacobi"
    assert cell.config.as_dict() == own


def test_every_cell_of_a_sweep_has_it() -> None:
    text = SCENE + "sweep: {one: {path: numerics.timestep, values: [1/100, 1/200]}}\n"
    cells = load_experiment_text(text, "case.yaml", solver="jacobi").cells()
    assert [cell.config.numerics.solver for cell in cells] == ["jacobi", "jacobi"]
    assert [cell.label for cell in cells] == ["one=1/100", "one=1/200"]
