"""What a cavity has no room for, or would touch in points that are not found, is refused."""

from __future__ import annotations

import pytest

from lavendersim.errors import LavenderError
from lavendersim.experiment import load_experiment_text

FLAT = "semi_axes: [0.4, 0.3, 0.2]"  # its flattest radius of curvature: 0.16/0.2 = 0.8 m


def text(shape: str, radius: float) -> str:
    return f"""
scene:
  bodies:
    drum: {{shape: {{kind: drum, radius: {radius}}}, position: [0, 0, 0]}}
    it: {{shape: {shape}, mass: 1, position: [0, 0, 0]}}
duration: 1.0
"""


@pytest.mark.parametrize("around", ["{}", "{{kind: compound, parts: [{{shape: {}}}]}}"])
@pytest.mark.parametrize(
    ("shape", "least", "reason"),
    [
        (f"{{kind: ellipsoid, {FLAT}}}", 0.8, "in two points at once"),
        ("{kind: sphere, radius: 0.4}", 0.4, "does not fit"),
        ("{kind: box, size: [2, 3, 0.5]}", 0.25, "does not fit"),
    ],
)
def test_a_cavity_that_is_too_narrow_is_refused(
    around: str, shape: str, least: float, reason: str
) -> None:
    shape = around.format(shape)
    load_experiment_text(text(shape, least * (1.0 + 1e-9)), "wide.yaml").cells()
    with pytest.raises(LavenderError, match=reason):
        load_experiment_text(text(shape, least * (1.0 - 1e-9)), "narrow.yaml").cells()
