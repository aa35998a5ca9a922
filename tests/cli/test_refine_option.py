"""`--refine` of `run` and `check`: time errors in a table, and the claims too narrow for them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from command_line import lavender

# Semi-implicit Euler falls g T h / 2 too far: 24.5 mm at h = 1/100, so half the timestep changes
# the fall by 12.3 mm. The claim leaves 12 mm about the number at h.
FALL = """\
question: How far does it fall?
expected: g T (T + h) / 2.
scene:
  bodies:
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, position: [0, 0, 5]}
numerics: {timestep: 1/100, integrator: semi_implicit_euler}
duration: 0.5
measure:
  fall: {kind: displacement, body: ball, along: [0, 0, -1]}
expect:
  - {name: falls, measure: fall, equals: {value: 1.250775, absolute: 0.012}}
"""


@pytest.fixture
def fall(tmp_path: Path) -> Path:
    path = tmp_path / "fall.yaml"
    path.write_text(FALL)
    return path


@pytest.mark.parametrize("verb", ["run", "check"])
def test_the_table_and_the_claim_that_is_too_narrow_are_printed(verb: str, fall: Path) -> None:
    done = lavender(verb, fall, "--refine", where=fall.parent)
    assert done.returncode == 0, done.stderr  # the claim holds; that it may not is no failure
    (line,) = [line for line in done.stdout.splitlines() if line.strip().startswith("fall ")]
    shown = [float(word) for word in line.replace("+-", "").split()[1:]]
    # at h, h/2, h/4, the order, at h = 0; then its bar to a digit, the time error to two
    assert shown[:5] == pytest.approx([1.250775, 1.2385125, 1.23238125, 1.0, 1.22625], abs=6e-6)
    assert shown[5:] == pytest.approx([0.00613, 0.0245], rel=0.05)
    assert "half the timestep changes it by 0.0122625, 'falls' leaves 0.012" in done.stdout


@pytest.mark.parametrize("verb", ["run", "check"])
def test_json_has_the_numbers_and_nothing_else_is_on_stdout(verb: str, fall: Path) -> None:
    done = lavender(verb, fall, "--refine", "--json", where=fall.parent)
    said = json.loads(done.stdout)
    ((row,),) = [(said[0] if verb == "run" else said)["time_errors"]]
    assert row["measure"] == "fall"
    assert row["exceeds"] is True
    assert row["order"] == pytest.approx(1.0, abs=1e-9)
    assert row["error"] == pytest.approx(9.81 * 0.5 / 200, abs=1e-9)


def test_without_it_there_is_none(fall: Path) -> None:
    done = lavender("run", fall, "--json", where=fall.parent)
    assert "time_errors" not in json.loads(done.stdout)[0]
    assert not list(fall.parent.glob("runs/*/refined"))


def test_a_matrix_has_no_time_errors(fall: Path) -> None:
    done = lavender("check", fall, "--refine", "--solver", "all", where=fall.parent)
    assert done.returncode == 2
    assert "--refine" in done.stderr
    assert not (fall.parent / "runs").exists()
