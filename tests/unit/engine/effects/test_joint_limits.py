"""What joints cannot be with is refused where the file has it, and nothing is without joints."""

from __future__ import annotations

import pytest

from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment_text

TEXT = """\
scene:
  bodies:
    hook: {shape: {kind: sphere, radius: 0.01}, fixed: true, position: [0, 0, 1]}
    bob: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [0, 0, 0]}
  connections:
    arm: {kind: ball, between: [hook, bob], at: [0, 0, 1]}
numerics: {timestep: 1/100}
duration: 0.1
"""
CASES = {
    "solver": ("solver: jacobi", "which jacobi does not solve; expected adaptive or projected"),
    "impacts": ("impacts: at_surface", "expected in_order or captured"),
    "simultaneous_impacts": ("simultaneous_impacts: pairwise", "expected together"),
    "sleeping": ("sleeping: true", "does not sleep"),
}


@pytest.mark.parametrize("key", CASES)
def test_numerics_that_joints_cannot_have_are_refused_at_their_place(key: str) -> None:
    written, sentence = CASES[key]
    text = TEXT.replace("{timestep: 1/100}", f"{{timestep: 1/100, {written}}}")
    with pytest.raises(ConfigError) as refused:
        load_experiment_text(text, "x.yaml").cells()
    column = text.splitlines()[6].index(written) + 1
    assert f"x.yaml:7:{column}: {key}: the scene has joints" in str(refused.value)
    assert sentence in str(refused.value)
    without = text.replace("    arm: {kind: ball, between: [hook, bob], at: [0, 0, 1]}\n", "")
    load_experiment_text(without.replace("  connections:\n", ""), "x.yaml").cells()


@pytest.mark.parametrize(
    ("old", "new", "place"),
    [
        (
            "numerics: {timestep: 1/100}",
            "study: {mistake: capture_in_sweeps}\nnumerics: {preset: chapter, tolerance: 1e-9}",
            "7:9",
        ),
        ("duration:", "record: {problems: every 2}\nduration:", "8:10"),
    ],
)
def test_sections_that_joints_cannot_have_are_refused_at_their_place(
    old: str, new: str, place: str
) -> None:
    with pytest.raises(ConfigError) as refused:
        load_experiment_text(TEXT.replace(old, new), "x.yaml").cells()
    assert "the scene has joints" in str(refused.value)
    assert f"x.yaml:{place}" in str(refused.value)


@pytest.mark.parametrize("integrator", ["midpoint", "semi_implicit_euler"])
def test_springs_beside_joints_are_refused_where_they_are_not_found_together(
    integrator: str,
) -> None:
    springs = "  springs: [{a: hook, b: bob, stiffness: 9}]\n  connections:"
    text = TEXT.replace("  connections:", springs)
    load_experiment_text(text, "x.yaml").cells()
    written = f"integrator: {integrator}"
    text = text.replace("{timestep: 1/100}", f"{{timestep: 1/100, {written}}}")
    with pytest.raises(ConfigError) as refused:
        load_experiment_text(text, "x.yaml").cells()
    assert "integrator: the scene has joints and springs" in str(refused.value)
    assert f"x.yaml:8:{text.splitlines()[7].index(written) + 1}" in str(refused.value)


@pytest.mark.parametrize("change", ["teleport: [0, 0, 3]", "orientation: [0, 1, 0, 0]"])
def test_an_event_that_would_tear_a_joint_is_refused_at_its_place(change: str) -> None:
    key = change.partition(":")[0]
    text = TEXT + f"events: [{{at: 0.05, body: bob, {change}}}]\n"
    with pytest.raises(ConfigError) as refused:
        load_experiment_text(text, "x.yaml").cells()
    column = text.splitlines()[8].index(change) + 1
    assert str(refused.value) == (
        f"x.yaml:9:{column}: {key}: bob has a joint, which this would tear; leave it out"
    )
    pushed = text.replace(change, "velocity: [1, 0, 0]")
    assert load_experiment_text(pushed, "x.yaml").cells()[0].config


def test_an_event_is_found_among_those_that_a_state_makes_happen() -> None:
    """A cell has these last; the file has them in any order."""
    turned = "body: bob, orientation: [0, 1, 0, 0]"
    events = [
        f"  - {{when: {{body: bob, faster_than: 1}}, {turned}}}",
        "  - {at: 0.02, body: bob, velocity: [1, 0, 0]}",
        f"  - {{when: null, at: 0.05, {turned}}}",
    ]
    text = TEXT + "\n".join(["events:", *events, ""])
    with pytest.raises(ConfigError) as refused:
        load_experiment_text(text, "x.yaml").cells()
    assert [(one.line, one.column) for one in refused.value.defects] == [
        (line, text.splitlines()[line - 1].index("orientation") + 1) for line in (9 + 1, 9 + 3)
    ]


def test_numerics_that_joints_can_have_are_taken() -> None:
    for numerics in ("chapter", "{timestep: 1/100}", "{solver: projected_gauss_seidel}"):
        text = TEXT.replace("numerics: {timestep: 1/100}", f"numerics: {numerics}")
        assert load_experiment_text(text, "x.yaml").cells()[0].config
