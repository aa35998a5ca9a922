"""The scenes that are timed: texts of configs, and engines at their initial state."""

from __future__ import annotations

from typing import NamedTuple

from lavendersim.cell import CellConfig
from lavendersim.engine.engine import Engine
from lavendersim.experiment import load_experiment_text
from lavendersim.scene.build import Scene, build
from lavendersim.scene.plan import Plan, plan_of

DROP = """\
scene:
  bodies:
    floor: {shape: {kind: plane}}
    ball:
      shape: {kind: sphere, radius: 0.1}
      mass: 1.0
      surface: {restitution: 0.8}
      release: {above: floor, clearance: 1.0}
numerics: {preset: chapter, timestep: 1/480}
duration: 1.0
"""

# In flight nothing is solved; at rest every step solves its contact.
REST = DROP.replace("release: {above: floor, clearance: 1.0}", "position: [0, 0, 0.1]")

# Without compliance the blocks rest inside the slop and the position pass ends before it begins.
# A pair of 2e-7 m/N under the load N rests at d - slop = c N / (beta + P / (1 - P)) = 0.7e-6 m/N N:
# every contact keeps asking for a correction, and all 22 position sweeps run in every step. The
# blocks start at the slop of 1 mm: sinking that far would take the top one 2 s.
STACK = (
    """\
scene:
  surfaces: {soft: {compliance: 1e-7}}
  bodies:
    floor: {shape: {kind: plane}, surface: soft}
"""
    + "".join(
        f"    block_{k}: {{shape: {{kind: box, size: [0.2, 0.2, 0.2]}}, mass: 1.0, "
        f"surface: soft, position: [0, 0, {0.099 + 0.199 * k:.3f}]}}\n"
        for k in range(6)
    )
    + """\
numerics: chapter
duration: 2.0
"""
)


class Case(NamedTuple):
    """A scene that can be started any number of times."""

    config: CellConfig
    plan: Plan
    steps: int  # of its duration
    text: str

    def scene(self) -> Scene:
        """Return the arrays of the initial state, anew."""
        return build(self.config, self.plan.spec)

    def engine(self) -> Engine:
        """Return an engine at the initial state, its kernel compiled or loaded."""
        engine = self.scene().engine(self.plan.spec)
        engine.advance(0)
        return engine


def case(text: str, record: bool) -> Case:
    """Return the only cell of a config, with or without the recording of rows."""
    (cell,) = load_experiment_text(text, "benchmark.yaml").cells()
    return Case(cell.config, plan_of(cell.config, record), cell.config.steps, text)
