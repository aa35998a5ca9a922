"""Kinds of `measures.py`: grafted as `from_file`, checked at the places of the config."""

from __future__ import annotations

import hashlib
from pathlib import Path

import pytest

from lavendersim.experiment.own_measures import with_own_measures
from lavendersim.experiment.text.node import Node
from lavendersim.experiment.text.parse import parse
from lavendersim.experiment.text.report import Report
from tests.marked_config import marked_places

OWN = """\
from lavendersim.measures import Trace, own_measure


@own_measure
def highest(trace: Trace, above: float = 0.0) -> float:
    \"\"\"Greatest height [m].\"\"\"
    return 0.0
"""


def grafted(tmp_path: Path, measure: str) -> tuple[Node | None, list[str], list[str]]:
    (tmp_path / "measures.py").write_text(OWN)
    text, places = marked_places(f"scene: {{}}\nmeasure: {{{measure}}}\n")
    report = Report("f")
    root = parse(text.encode(), report)
    assert root is not None
    found = with_own_measures(root, {"f": tmp_path / "f.yaml"}, report)
    said = [str(defect).removeprefix("f:") for defect in report.defects]
    return (None if found is None else found[0]), said, places


def test_a_kind_of_the_file_becomes_one_of_a_file_with_its_digest(tmp_path: Path) -> None:
    tree, said, _ = grafted(tmp_path, "hop: {kind: highest, above: 2}")
    assert said == []
    assert tree is not None
    assert tree.get("measure", "hop").data == {
        "kind": "from_file",
        "function": "highest",
        "sha256": hashlib.sha256(OWN.encode()).hexdigest(),
        "meaning": "Greatest height [m].",
        "parameters": {"above": 2},
    }


@pytest.mark.parametrize(
    ("measure", "sentence"),
    [
        ("hop: {kind: highest, above: §much}", 'above: expected a number, found the text "much"'),
        (
            "hop: {kind: highest, §abov: 2}",
            'unknown key "abov" in measure.hop; did you mean "above"?',
        ),
        (
            "a: {kind: highest}, hop: {kind: §heighest}",
            'unknown kind "heighest" in measure.hop; did you mean "highest"?',
        ),
    ],
)
def test_what_is_wrong_is_said_at_its_place(tmp_path: Path, measure: str, sentence: str) -> None:
    _, said, (place,) = grafted(tmp_path, measure)
    assert said == [f"{place}: {sentence}"]


def test_the_file_is_not_run_where_no_kind_of_it_is_named(tmp_path: Path) -> None:
    (tmp_path / "measures.py").write_text("raise SystemExit('run')\n")
    root = parse(b"measure: {p: {kind: peak_force, body: ball}}", Report("f"))
    assert root is not None
    assert with_own_measures(root, {"f": tmp_path / "f.yaml"}, Report("f")) is None
    (tmp_path / "measures.py").unlink()
    named = parse(b"measure: {p: {kind: highest}}", Report("f"))
    assert named is not None
    assert with_own_measures(named, {"f": tmp_path / "f.yaml"}, Report("f")) is None


def test_keys_of_every_measure_stay_beside_the_kind(tmp_path: Path) -> None:
    tree, said, _ = grafted(
        tmp_path, "hop: {kind: highest, above: 2, over: {form: weight, bodies: [ball]}}"
    )
    assert tree is not None
    assert tree.get("measure", "hop", "parameters").data == {"above": 2}
    assert tree.get("measure", "hop", "over", "form").text == "weight"
    assert said == []


def test_a_kind_that_is_no_text_is_left_to_others(tmp_path: Path) -> None:
    assert grafted(tmp_path, "hop: {kind: 3}")[:2] == (None, [])
