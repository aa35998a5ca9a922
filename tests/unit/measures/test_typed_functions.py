"""A typed function in a module of another package is a kind of measure, as one in a file is."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from lavendersim.errors import ConfigError, UsageError
from lavendersim.measures.typed_functions import kind_of, own_measure, take

MODULE = '''\
from lavendersim.measures import Trace, own_measure
from lavendersim.quantities.names import BodyName


@own_measure
def last_step(trace: Trace, body: BodyName, times: int = 1) -> float:
    """Number [-] of the last logged step. It is multiplied."""
    return times * trace.step["step"][-1]
'''
TEXT = """\
scene: {bodies: {ball: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [0, 0, 1]}}}
duration: 0.1
measure: {last: MEASURE}
"""
LOAD = """
import sys
from lavendersim.errors import LavenderError
from lavendersim.experiment import load_experiment_text
try:
    experiment = load_experiment_text(sys.argv[1], "c.yaml")
except LavenderError as error:
    print(error)
    sys.exit()
spec = experiment.measures["last"]
"""
EVALUATE = """
import pickle
from types import SimpleNamespace
from lavendersim.errors import LavenderError
from lavendersim.measures import evaluate
try:
    print(evaluate(pickle.loads(pickle.dumps(spec)), SimpleNamespace(step={"step": [0, 1, 7]})))
except LavenderError as error:
    print(error)
"""


class Installed:
    """A distribution with a module of measures, beside lavender."""

    def __init__(self, folder: Path, module: str = MODULE) -> None:
        self.folder, self.file = folder, folder / "others_functions.py"
        self.file.write_text(module)
        info = folder / "others-1.0.dist-info"
        info.mkdir()
        (info / "METADATA").write_text("Metadata-Version: 2.1\nName: others\nVersion: 1.0\n")
        entry = "[lavendersim.measures]\nlast = others_functions\n"
        (info / "entry_points.txt").write_text(entry)

    def python(self, program: str, *arguments: str, given: bytes = b"") -> bytes:
        """Run a program beside it; returns what it prints."""
        path = os.pathsep.join([str(self.folder), os.environ.get("PYTHONPATH", "")])
        done = subprocess.run(
            [sys.executable, "-c", program, *arguments],
            input=given,
            capture_output=True,
            timeout=60,
            check=False,
            env=os.environ | {"PYTHONPATH": path},
        )
        assert done.returncode == 0, done.stderr.decode()
        return done.stdout.strip()

    def said(self, measure: str, program: str = LOAD + EVALUATE) -> str:
        """Return what is printed of a config with this measure."""
        return self.python(program, TEXT.replace("MEASURE", measure)).decode()


def test_a_config_names_its_kind_and_a_log_is_measured(tmp_path: Path) -> None:
    others = Installed(tmp_path)
    assert others.said("{kind: last_step, body: ball, times: 3}") == "21.0"
    assert others.said("{kind: last_step, body: ball}") == "7.0"
    first = "import others_functions\n" + LOAD + EVALUATE  # as where that package tests itself
    assert others.said("{kind: last_step, body: ball, times: 3}", first) == "21.0"


@pytest.mark.parametrize(
    ("measure", "at", "sentence"),
    [
        ("{kind: last_step, bdy: ball}", "bdy",
         'unknown key "bdy" in measure.last; did you mean "body"?'),
        ("{kind: last_step, body: bal}", "bal}",
         'body: no body is called "bal"; did you mean "ball"?'),
        ("{kind: last_step, body: ball, times: 1.5}", "1.5",
         "times: expected a whole number, found 1.5"),
        ("{kind: last_step}", "{kind: last_step}", 'missing key "body" in measure.last'),
        ("{kind: last_stp, body: ball}", "last_stp",
         'unknown kind "last_stp" in measure.last; did you mean "last_step"?'),
    ],
)  # fmt: skip
def test_its_parameters_are_refused_at_their_places(
    tmp_path: Path, measure: str, at: str, sentence: str
) -> None:
    line = TEXT.replace("MEASURE", measure).splitlines()[2]
    said = Installed(tmp_path).said(measure).splitlines()
    assert said[0].startswith(f"c.yaml:3:{line.index(at) + 1}: {sentence}")


def test_other_processes_are_given_it(tmp_path: Path) -> None:
    others = Installed(tmp_path)
    send = "\nimport pickle\nsys.stdout.buffer.write(pickle.dumps(spec))\n"
    text = TEXT.replace("MEASURE", "{kind: last_step, body: ball, times: 3}")
    sent = others.python(LOAD + send, text)
    take_it = "import pickle, sys\nspec = pickle.load(sys.stdin.buffer)\n" + EVALUATE
    assert others.python(take_it, given=sent) == b"21.0"


def test_an_error_of_it_has_its_line(tmp_path: Path) -> None:
    others = Installed(tmp_path, MODULE.replace("return times", "return 1 // 0 * times"))
    said = others.said("{kind: last_step, body: ball}")
    assert said == (
        f"{others.file}:8: last_step: ZeroDivisionError: integer division or modulo by zero"
    )


def test_a_function_without_types_is_refused_at_its_line(tmp_path: Path) -> None:
    others = Installed(tmp_path, MODULE.replace("times: int = 1", "times=1"))
    said = others.said("{kind: last_step, body: ball}", f"try:\n{_indented(LOAD)}\n{CATCH}")
    assert "others_functions of the distribution others cannot be imported: " in said
    assert f"{others.file}:5:1: last_step: times: expected a type, such as times: float" in said


CATCH = "except Exception as error:\n    print(error)"


def _indented(text: str) -> str:
    return "\n".join(f"    {line}" for line in text.splitlines())


def test_it_is_listed_with_unit_meaning_and_parameters(tmp_path: Path) -> None:
    listed = (
        "from lavendersim.measures.meanings import described_kinds\n"
        "one = described_kinds()['last_step']\n"
        "print(one.meaning, one.unit, one.package, one.parameters, sep=';')"
    )
    assert Installed(tmp_path).python(listed).decode() == (
        "Number of the last logged step;-;others_functions;{'body': '', 'times': ' (default 1)'}"
    )


@own_measure
def spread_of_steps(trace: Any, least: float = 0.0) -> float:
    """Largest step [-] less the least."""
    return float(max(trace.step)) - least


def test_what_is_taken_is_a_number_or_a_row() -> None:
    kind = kind_of(spread_of_steps)
    assert kind is not None
    assert take(kind, SimpleNamespace(step=[1, 5]), {"least": 2.0}, "f.py") == 3.0  # type: ignore[arg-type]
    row = kind._replace(function=lambda trace: [1, 2])
    assert list(take(row, None, {}, "f.py")) == [1.0, 2.0]  # type: ignore[arg-type]
    table = kind._replace(function=lambda trace: [[1, 2]])
    with pytest.raises(UsageError, match="expected a number or a row, found 2-D"):
        take(table, None, {}, "f.py")  # type: ignore[arg-type]
    assert kind_of(take) is None


def test_two_functions_of_one_name_are_refused() -> None:
    def spread_of_steps(trace: Any) -> float:
        return 0.0

    with pytest.raises(ConfigError, match="SpreadOfStepsMeasure, of which the module has one"):
        own_measure(spread_of_steps)


def test_its_model_is_found_where_a_pickle_looks_for_it() -> None:
    kind = kind_of(spread_of_steps)
    assert kind is not None
    model = globals()["SpreadOfStepsMeasure"]
    spec = model(kind="spread_of_steps", least=1.0)
    assert pickle.loads(pickle.dumps(spec)) == spec
