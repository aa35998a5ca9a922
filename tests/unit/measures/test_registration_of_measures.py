"""Measures of another distribution: found by their entry point, and refused in a sentence."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

MODULE = """\
from typing import Literal

from pydantic import Field

from lavendersim.measures import Measure, measure


class LastStep(Measure):
    '''Number of the last logged step.'''

    kind: Literal["{kind}"]
    times: int = Field(default=1, description="factor")


@measure(LastStep)
def last_step(spec, trace):
    return spec.times * float(trace.step["step"][-1])
"""
EVALUATED = """\
from types import SimpleNamespace
from lavendersim.experiment import load_experiment_text
from lavendersim.measures import evaluate

text = '''
scene: {bodies: {ball: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [0, 0, 1]}}}
duration: 0.1
measure: {last: {kind: last_step, times: 3}}
'''
spec = load_experiment_text(text, "c.yaml").measures["last"]
print(evaluate(spec, SimpleNamespace(step={"step": [0, 1, 7]})))
"""
REFUSED = """\
from lavendersim.errors import UsageError
try:
    import lavendersim.experiment
except UsageError as error:
    print(error)
"""


def python(program: str, place: Path, module: str) -> str:
    """Run a program beside a distribution that brings this module of measures."""
    (place / "others_measures.py").write_text(module)
    info = place / "others-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: others\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[lavendersim.measures]\nlast = others_measures\n")
    path = os.pathsep.join([str(place), os.environ.get("PYTHONPATH", "")])
    done = subprocess.run(
        [sys.executable, "-c", program],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
        env=os.environ | {"PYTHONPATH": path},
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_a_config_names_the_kind_and_a_log_is_measured(tmp_path: Path) -> None:
    assert python(EVALUATED, tmp_path, MODULE.format(kind="last_step")) == "21.0"


def test_the_module_may_be_the_first_that_is_imported(tmp_path: Path) -> None:
    """As it is when the other distribution tests itself."""
    program = "import others_measures\n" + EVALUATED
    assert python(program, tmp_path, MODULE.format(kind="last_step")) == "21.0"


def test_a_kind_that_is_taken_is_refused(tmp_path: Path) -> None:
    said = python(REFUSED, tmp_path, MODULE.format(kind="tilt"))
    assert "others_measures of the distribution others: there is a 'tilt' already" in said


def test_a_module_that_cannot_be_imported_is_refused(tmp_path: Path) -> None:
    said = python(REFUSED, tmp_path, "import nothing_of_this_name\n")
    assert "others_measures of the distribution others cannot be imported" in said
