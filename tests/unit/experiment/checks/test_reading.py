"""One validation: rules where mappings stand, names that exist, selections of swept values."""

from __future__ import annotations

import pytest

from lavendersim.experiment.checks.reading import Reading, same_value
from lavendersim.experiment.models.experiment import CellSource, NumericsSource
from lavendersim.experiment.text.node import Mark, Node, graft
from lavendersim.experiment.text.parse import parse
from lavendersim.experiment.text.place import Place
from lavendersim.experiment.text.report import Report
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.scalars import resolve
from tests.marked_config import BALL, FLOOR, assert_refused, config, refusals


class Inner(ConfigModel):
    number: int

    @classmethod
    def rules(cls, at: Place) -> None:
        at.refuse(at.key("number"), f"{at} is looked at")


class Outer(ConfigModel):
    first: Inner | None = None
    listed: tuple[Inner, ...] = ()
    other: int = 0


def read(text: str, only: tuple[str, ...] | None = None) -> tuple[object, list[str]]:
    report = Report("f")
    root = parse(text.encode(), report)
    assert root is not None
    model = Reading(root, (), report).read(Outer, only)
    return model, [str(defect) for defect in report.defects]


def test_rules_of_a_model_are_applied_at_every_mapping_that_is_read_as_it() -> None:
    model, found = read("first: {number: 1}\nlisted: [{number: 2},\n  {number: 3}]")
    assert model == Outer(first=Inner(number=1), listed=(Inner(number=2), Inner(number=3)))
    assert found == [
        "f:1:9: first is looked at",
        "f:2:11: listed[0] is looked at",
        "f:3:4: listed[1] is looked at",
    ]


def test_rules_are_applied_although_another_value_is_wrong() -> None:
    model, found = read("first: {number: 1}\nother: many")
    assert model is None
    assert found[0] == "f:1:9: first is looked at"
    assert len(found) == 2


def test_only_some_sections_are_read() -> None:
    model, found = read("first: {number: wrong}\nother: 3", only=("other",))
    assert (model, found) == (Outer(other=3), [])


def one(text: str) -> Node:
    return Node(resolve(text), Mark(1, 1))


@pytest.mark.parametrize(
    ("first", "other", "same"),
    [
        ("1/500", "0.002", True),
        ("1/3", "0.333333", False),
        ("1", "1.0", True),
        ("true", "1", False),
        ("a", "a", True),
        ("a", "null", False),
    ],
)
def test_values_are_compared_exactly_as_they_are_written(
    first: str, other: str, same: bool
) -> None:
    assert same_value(one(first), one(other)) is same


def refusal(kind: str, name: str) -> str | None:
    box = "box: {shape: {kind: box, size: [1, 1, 1]}, mass: 1, position: [0, 0, 5]}"
    pins = "arrangements: {pin: {kind: rack, rows: 2, body: {shape: {kind: box, size: [1, 1, 1]}}}}"
    text = f"scene: {{bodies: {{{FLOOR}, {BALL}, {box}}}, {pins}}}"
    root = parse(text.encode(), Report(""))
    assert root is not None
    return Reading(root, ("mass",), Report("")).refusal_of(kind, name)  # type: ignore[arg-type]


def test_names_are_looked_up_by_what_they_name() -> None:
    assert refusal("body", "ball") is None
    assert refusal("plane", "floor") is None
    assert refusal("axis", "mass") is None
    assert refusal("body", "bal") == 'no body is called "bal"; did you mean "ball"?'
    assert refusal("measure", "peak") == 'no measure is called "peak"; this file has none'
    assert refusal("plane", "ball") == '"ball" is a sphere, expected the name of a plane'
    for name in ("ball", "pin", "pin_2"):
        assert refusal("body or arrangement", name) is None
    pim = refusal("body or arrangement", "pim")
    assert pim == 'no body or arrangement is called "pim"; did you mean "pin"?'
    assert refusal("body", "pin") is not None  # one body is asked for
    unknown = refusal("plane", "flor")  # balls and boxes are no answer
    assert unknown == 'no plane is called "flor"; did you mean "floor"?'


def test_a_selection_has_values_of_its_axis() -> None:
    swept = {"sweep": "{dt: {path: numerics.timestep, values: [1/100, 1/200]}}"}
    swept["measure"] = "{a: {kind: apex_error, body: ball, above: floor}}"
    claim = "[{name: it, measure: a, at_most: 1, at: {dt: VALUE}}]"
    for value in ("0.01", "any", "[1/100, 0.005]"):
        assert refusals(config(**swept, expect=claim.replace("VALUE", value))) == []
    assert_refused(
        config(**swept, expect=claim.replace("VALUE", "[1/100, §1/300]")),
        "dt: 1/300 is not among the swept values 1/100, 1/200",
    )


def cell_source(root: Node) -> CellSource:
    """Read the part of a config that a cell is made of, and note it."""
    report = Report("f")
    reading = Reading(root, (), report)
    found = reading.read(CellSource, only=CellSource.model_fields)
    assert found is not None
    assert report.close_round()
    reading.keep(found)
    return found


def test_numerics_of_one_node_are_read_once_and_those_of_another_anew() -> None:
    scene = f"scene: {{bodies: {{{FLOOR}, {BALL}}}}}\nduration: 1\n"
    text = f"{scene}numerics: {{timestep: 1/100, sweeps: 7}}"
    root = parse(text.encode(), Report(""))
    assert root is not None
    longer = graft(root, ("duration",), Node(2.0, root.mark))
    one, other = cell_source(root), cell_source(longer)
    assert (one.duration, other.duration) == (1.0, 2.0)
    assert one.numerics is other.numerics
    swept = cell_source(graft(root, ("numerics", "sweeps"), Node(8, root.mark)))
    assert isinstance(one.numerics, NumericsSource)
    assert isinstance(swept.numerics, NumericsSource)
    assert (one.numerics.sweeps, swept.numerics.sweeps) == (7, 8)
    assert one.numerics == NumericsSource(timestep=one.numerics.timestep, sweeps=7)


def test_what_is_not_asked_for_is_not_read_though_it_is_known() -> None:
    text = f"scene: {{bodies: {{{FLOOR}, {BALL}}}}}\nduration: 1\nnumerics: {{sweeps: 7}}"
    root = parse(text.encode(), Report(""))
    assert root is not None
    cell_source(root)
    fields = CellSource.model_fields.keys() - {"numerics"}
    found = Reading(root, (), Report("")).read(CellSource, only=fields)
    assert found is not None
    assert found.numerics == "default"


def test_numerics_that_are_refused_are_refused_in_every_cell() -> None:
    bodies = f"{FLOOR}, {BALL}"
    swept = "{e: {path: duration, values: [1, 2]}}"
    found = refusals(
        f"scene: {{bodies: {{{bodies}}}}}\nduration: 1\nsweep: {swept}\nnumerics: {{sweeps: -1}}"
    )
    assert len(found) == 1
    assert "sweeps" in found[0]
