"""Configs of a floor and a few bodies, for rules that look at them without running anything."""

from __future__ import annotations

from lavendersim.errors import Defect
from lavendersim.experiment import load_experiment_text
from lavendersim.lint import suspicions

FLOOR = "    floor: {shape: {kind: plane}}\n"
CLAIM = "always: {}\n"


def config(*bodies: str, floor: str = FLOOR, rest: str = CLAIM, surfaces: str = "") -> str:
    """Return the text of a config; each body is a line of `bodies`."""
    lines = "".join(f"    {body}\n" for body in bodies)
    return f"scene:\n{surfaces}  bodies:\n{floor}{lines}duration: 0.1\n{rest}"


def found(text: str) -> list[Defect]:
    """Return what is suspicious of a config."""
    return suspicions(load_experiment_text(text, "scene.yaml"))
