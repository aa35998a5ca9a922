"""Measures of other measures, declared in YAML, and the list of all measures."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from damaged_runs import made, verb

from lavendersim import open_run
from lavendersim.measures.specs.catalogue import KINDS
from tests.drop_config import SCENE

MEASURES = """\
duration: 1.0
measure:
  rebound: {kind: first_apex, body: ball, above: floor}
  peak: {kind: peak_force, body: ball}
  before: {kind: approach_velocity, body: ball}
  after: {kind: separation_velocity, body: ball}
  energies: {kind: energy_by_bounce, body: ball, above: floor, bounces: 2}
  restitution: {kind: ratio, measure: after, to: before}
  change: {kind: difference, measure: after, minus: before}
  nothing: {kind: difference, measure: peak, minus: peak}
  by_nothing: {kind: ratio, measure: peak, to: nothing}
  largest: {kind: of_row, measure: energies, of: max}
  smallest: {kind: of_row, measure: energies, of: min}
  end: {kind: of_row, measure: energies, of: last}
  from_largest: {kind: difference, measure: energies, minus: largest}
  share:
    kind: ratio
    measure: rebound
    to: rebound
    against: {form: rebound_height, bodies: [ball, floor]}
expect:
  - {name: newton, measure: restitution, between: [-0.53, -0.47]}
"""


def config(measures: str = MEASURES) -> str:
    return f"question: What do measures of measures give?\nexpected: Arithmetic.\n{SCENE}{measures}"


@pytest.fixture(scope="module")
def values(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    run = made(config(), tmp_path_factory.mktemp("run"))
    found: dict[str, Any] = open_run(run).results()["cells"][0]["measures"]
    return found


def test_a_ratio_and_a_difference_are_those_of_the_numbers(values: dict[str, Any]) -> None:
    assert values["restitution"] == values["after"] / values["before"]
    assert values["change"] == values["after"] - values["before"]


def test_a_ratio_to_nothing_is_no_number(values: dict[str, Any]) -> None:
    assert (values["nothing"], values["by_nothing"]) == (0.0, "nan")


def test_of_a_row_one_number_is_taken(values: dict[str, Any]) -> None:
    row = values["energies"]
    assert (values["largest"], values["smallest"]) == (max(row), min(row))
    assert values["end"] == row[-1]
    assert values["from_largest"] == (np.array(row) - max(row)).tolist()


def test_a_closed_form_stands_beside_it_as_beside_any_measure(values: dict[str, Any]) -> None:
    """The ratio is 1, e^2 h is 0.025 m: |1 / 0.025 - 1| = 39, to the round-off of 0.5^2 * 0.1."""
    assert values["share"] == pytest.approx(39.0, rel=1e-14)


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("to: before", "to: befor", 'did you mean "before"?'),
        (
            "minus: before",
            "minus: change",
            'minus: expected a measure above "change"',
        ),
        (
            "measure: after, to",
            "measure: end, to",
            'measure: expected a measure above "restitution"',
        ),
        ("of: max", "of: median", "of: expected max or min or mean or sum or first or last, found"),
        (", to: before", "", 'missing key "to"'),
    ],
)
def test_a_bad_one_is_refused_at_its_place(
    old: str, new: str, sentence: str, tmp_path: Path
) -> None:
    file = tmp_path / "drop.yaml"
    text = config(MEASURES.replace(old, new, 1))
    file.write_text(text)
    done = verb("run", file, "--runs", tmp_path / "runs")
    assert (done.code, done.stdout) == (2, "")
    assert sentence in done.stderr
    where = text[: text.index(new or "measure: after}")].count("\n") + 1
    assert f"{file}:{where}:" in done.stderr
    assert not (tmp_path / "runs").exists()


def test_every_measure_is_listed_with_unit_and_meaning() -> None:
    lines = verb("measures").stdout.splitlines()
    named = [kind for kind in KINDS if kind != "from_file"]  # the form that runs keep
    assert [line.split()[0] for line in lines] == named
    found = json.loads(verb("measures", "--json").stdout)
    assert found["peak_force"]["unit"] == "N"
    assert found["tilt"]["unit"] == "degree"
    assert all(one["meaning"] for one in found.values())
    assert set(found["first_apex"]["parameters"]) == {"body", "above"}


def test_of_one_measure_the_parameters_are_printed_and_a_wrong_name_is_refused() -> None:
    assert "  body: the body that rebounds" in verb("measures", "first_apex").stdout
    done = verb("measures", "first_apx")
    assert (done.code, done.stdout) == (2, "")
    assert 'did you mean "first_apex"?' in done.stderr
