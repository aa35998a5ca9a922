"""A sweep is planned by classes of cells that differ in numbers of bodies alone.

What comes out is what planning each cell by itself gives. Cells are built by classes and not one
by one, and a value that cannot be is found in the last cell as in the first. What that takes,
`tests.benchmarks.sizes` measures.
"""

from __future__ import annotations

import tracemalloc
from typing import Any

import pytest

from lavendersim.errors import ConfigError
from lavendersim.experiment import Experiment, load_experiment_text
from lavendersim.experiment import cell as cells_module
from lavendersim.experiment import load as loading
from lavendersim.experiment.cell import alike
from lavendersim.runner import plans as planning
from lavendersim.runner.plans import distinct, shared_plans
from lavendersim.scene.facts import facts_of
from lavendersim.scene.numbers_read import MASSES, STARTS
from lavendersim.scene.plan import plan_of_cell, union

DROPS = """scene:
  gravity: {gravity}
  bodies:
    floor: {{shape: {{kind: plane}}}}
    ball:
      shape: {{kind: sphere, radius: 0.1}}
      mass: 1
      release: {{above: floor, clearance: 1}}
      velocity: [0, 0, 0]
constants: {{c: 1/4}}
duration: 1
sweep:
{axes}
always: {{}}
"""
# Two balls above a floor: whether one gets fast enough to pass the other, their heights decide.
PAIR = """scene:
  bodies:
    floor: {{shape: {{kind: plane}}}}
    low: {{shape: {{kind: sphere, radius: 0.02}}, mass: 1, position: [0, 0, 0.02]}}
    high: {{shape: {{kind: sphere, radius: 0.02}}, mass: 1, position: [0, 0, 0.1]}}
numerics: {{timestep: 1/960}}
duration: 1
sweep:
{axes}
always: {{}}
"""
E = "  e: {path: scene.bodies.ball.surface.restitution, values: [0, 0.3, 0.6]}"
H = "  h: {path: scene.bodies.ball.release.clearance, values: %s}"
PHASE = "  p: {path: scene.bodies.ball.release.phase, values: [0, 1/4, 1/2]}"
TOGETHER = """  s:
    paths: [scene.bodies.ball.release.clearance, scene.bodies.ball.velocity.0]
    range: {from: 1, to: 2, steps: 4}"""
OWN = """  s:
    paths:
      scene.bodies.ball.release.clearance: [$c, 2 * $c, 3 * $c]
      scene.bodies.ball.release.phase: [0, $c, 2 * $c]"""
MIXED = (
    "  s: {paths: [scene.bodies.ball.release.clearance, scene.bodies.ball.mass], values: [1, 2]}"
)
M = "  m: {path: scene.bodies.ball.mass, values: %s}"
HEAVY = "  m: {path: scene.bodies.ball.mass, values: [0.5, 1, 2, 1e9]}"
BRIGHT = (
    "  s: {paths: [scene.bodies.ball.mass, scene.bodies.ball.surface.friction], values: [1, 2]}"
)
SPEED = "  v: {path: scene.bodies.ball.velocity, values: [[0, 0, 0], [1, 0, 0], [0, 2, 0]]}"
Z = "  z: {path: scene.bodies.high.position.2, values: [0.1, 0.12, 4, 50]}"
MASS = "  m: {path: scene.bodies.high.mass, values: [1, 2]}"


def drops(*axes: str, gravity: str = "9.81") -> Experiment:
    return load_experiment_text(DROPS.format(axes="\n".join(axes), gravity=gravity), "drops.yaml")


def classes(experiment: Experiment) -> int:
    return len(alike(experiment.cells()))


@pytest.mark.parametrize(
    ("axes", "expected"),
    [
        ((E, H % "[1, 2]"), 3),
        ((H % "[1, 2]", E), 3),
        ((E, PHASE), 6),
        ((E, SPEED), 3),
        ((E, TOGETHER), 3),
        ((E, OWN), 6),
        ((E, MIXED), 3),
        ((E, HEAVY), 3),
        ((E, BRIGHT), 6),
    ],
    ids=[
        "starts inside",
        "starts outside",
        "phases, of which none is one class",
        "speeds",
        "starts moved together",
        "starts and phases by formulas",
        "starts moved with masses",
        "masses",
        "masses moved with a friction",
    ],
)
def test_a_class_is_planned_as_each_of_its_cells_is(axes: tuple[str, ...], expected: int) -> None:
    experiment = drops(*axes)
    assert classes(experiment) == expected
    (plan,) = distinct(shared_plans(experiment.cells()))
    assert plan == union([plan_of_cell(cell) for cell in experiment.cells()])


@pytest.mark.parametrize("axes", [(Z, MASS), (MASS, Z)])
def test_cells_whose_heights_decide_are_planned_one_by_one(axes: tuple[str, ...]) -> None:
    text = PAIR.format(axes="\n".join(axes))
    cells = load_experiment_text(text, "pair.yaml").cells()
    own = [plan_of_cell(cell) for cell in cells]
    on = [plan.decisions["fast_bodies"].on for plan in own]
    assert len(alike(cells)) == 1
    assert len(set(on)) == 2  # 0.1 m is no fall, 50 m is one: the claim would be empty otherwise
    (plan,) = distinct(shared_plans(cells))
    assert plan == union(own)
    assert len(plan.required_by["fast_bodies"]) == sum(on)


def test_where_masses_alone_decide_starts_are_planned_together(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """No effect asks for a mass without asking for heights: one that does is put in their place."""
    cells = drops(HEAVY, H % "[1, 2, 3]").cells()
    (before,) = distinct(shared_plans(cells))
    asked: list[float] = []
    decide = planning.plan_of_cell

    def heavy(cell: Any, read: Any = None) -> Any:
        plan = decide(cell, read=read)
        mass = cell.config.scene.bodies["ball"].mass
        asked.append(mass)
        if read is not None:
            read.masses = True
        reasons = {name: one._replace(reason=f"{mass:g}") for name, one in plan.decisions.items()}
        return plan._replace(decisions=reasons)

    monkeypatch.setattr(planning, "plan_of_cell", heavy)
    (plan,) = distinct(shared_plans(cells))
    assert asked[1:] == [0.5] * 3 + [1.0] * 3 + [2.0] * 3 + [1e9] * 3
    assert plan.cells == before.cells
    assert plan.reasons_of("drag")["2"] == tuple(name for name in plan.cells if "m=2" in name.label)


@pytest.mark.parametrize("axis", [H % "[1, 2]", PHASE, SPEED, TOGETHER, OWN, HEAVY, MIXED])
def test_facts_that_differ_in_numbers_of_bodies_are_those_that_are_watched(axis: str) -> None:
    first, *_, last = (facts_of(cell.config) for cell in drops(axis).cells())
    apart = {
        name
        for one, other in zip(first.bodies, last.bodies, strict=True)
        for name, value in one._asdict().items()
        if name != "config" and value != getattr(other, name)
    }
    watched = STARTS | MASSES
    assert apart <= watched
    within = {
        name
        for one, other in zip(first.bodies, last.bodies, strict=True)
        for name, value in one.config
        if value != getattr(other.config, name)
    }
    assert within
    assert within <= watched
    others = {name for name, value in first._asdict().items() if value != getattr(last, name)}
    assert others <= {"bodies", "scene"}
    scenes = {name for name, value in first.scene if value != getattr(last.scene, name)}
    assert scenes == {"bodies"}


def many(count: int, last: str, axis: str = H) -> str:
    """Return the axis of so many clearances, or others, whose last one is as it is given."""
    values = [f"{1 + k / 1000:g}" for k in range(count - 1)] + [last]
    return axis % f"[{', '.join(values)}]"


@pytest.mark.parametrize("axis", [H, M])
@pytest.mark.parametrize("last", ["-1", "1e60", "high", "[1]"])
def test_a_value_that_cannot_be_is_found_behind_those_whose_cells_are_built(
    last: str, axis: str
) -> None:
    count = loading.MOST_CELLS_CHECKED + 500
    with pytest.raises(ConfigError) as refused:
        drops(many(count, last, axis))
    with pytest.raises(ConfigError) as alone:  # the sentence of a sweep that is built whole
        drops(many(2, last, axis))
    assert [one.message for one in refused.value.defects] == [
        one.message for one in alone.value.defects
    ]


def test_values_that_do_not_go_together_are_found_in_the_last_cell() -> None:
    """A phase needs gravity that pulls: true of every value by itself, but not of the last two."""
    count = loading.MOST_CELLS_CHECKED // 3
    gravity = "  g: {path: scene.gravity, values: [%s, 0]}"
    pulls = gravity % ", ".join(f"{9 + k / 1000:g}" for k in range(count))
    experiment = drops(PHASE.replace("1/4, 1/2", "1/4, 1/2, 3/4"), pulls)
    assert len(experiment.cells()) > loading.MOST_CELLS_CHECKED
    with pytest.raises(ConfigError, match="gravity does not pull towards floor"):
        shared_plans(experiment.cells())


def swept(cells: int) -> str:
    """Return the config of so many cells, in ten classes."""
    values = ", ".join(f"{k / 100:g}" for k in range(10))
    axes = (
        f"  e: {{path: scene.bodies.ball.surface.restitution, values: [{values}]}}",
        many(cells // 10, "3"),
    )
    return DROPS.format(axes="\n".join(axes), gravity="9.81")


def plan_all(text: str) -> None:
    assert len(distinct(shared_plans(load_experiment_text(text, "drops.yaml").cells()))) == 1


def test_a_tenth_of_the_largest_sweep_builds_few_cells(monkeypatch: pytest.MonkeyPatch) -> None:
    built: list[Any] = []
    build = cells_module.build_cell

    def counted(*how: Any) -> Any:
        built.append(None)
        return build(*how)

    monkeypatch.setattr(cells_module, "build_cell", counted)
    monkeypatch.setattr(loading, "build_cell", counted)
    plan_all(swept(10_000))
    # every value by itself, as far as that is done, and the first cell of every class
    assert len(built) <= loading.MOST_CELLS_CHECKED + 10


def test_a_cell_more_takes_little_memory() -> None:
    """The bar is 300 MB for 100,000, of which a process without a sweep takes some 130."""
    peaks = []
    for count in (2_000, 12_000):
        text = swept(count)
        tracemalloc.start()
        plan_all(text)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    assert (peaks[1] - peaks[0]) / 10_000 <= 1_700.0


def test_cells_of_other_experiments_are_no_class_of_its_cells() -> None:
    """Without a sweep, too: each has its own bodies."""
    ball = DROPS.partition("sweep:")[0]
    box = ball.replace("{kind: sphere, radius: 0.1}", "{kind: box, size: [0.2, 0.2, 0.2]}")
    cells = [
        load_experiment_text(text.format(gravity="9.81"), "one.yaml").cells()[0]
        for text in (ball, box)
    ]
    assert alike(cells) == [[cells[0]], [cells[1]]]
    (plan,) = distinct(shared_plans(cells))
    assert set(plan.spec.shape_pairs) == {"sphere_plane", "box_plane"}
