"""Bodies as written: what a plane, a fixed, a kinematic and a movable body each may have."""

from __future__ import annotations

import pytest

from tests.marked_config import BALL, assert_refused, config, refusals, scene

PLACE = "scene.bodies.it"
FIXED = "a fixed body has no"


def with_body(words: str) -> str:
    return config(scene=scene(BALL, f"it: {{{words}}}"))


SPHERE = "shape: {kind: sphere, radius: 1}"


@pytest.mark.parametrize(
    "words",
    [
        "shape: {kind: plane}",
        "shape: {kind: plane}, fixed: true",
        f"{SPHERE}, position: [0, 0, 9], fixed: true",
        f"{SPHERE}, position: [0, 0, 9], kinematic: true, velocity: [1, 0, 0]",
        f"{SPHERE}, position: [0, 0, 9], density: 7800",
        # 1 + 2 = 3: a flat body, the limit of the triangle inequality of moments
        f"{SPHERE}, position: [0, 0, 9], mass: 1, inertia: [1, 3, 2]",
    ],
)
def test_what_a_body_may_have_is_read(words: str) -> None:
    assert refusals(with_body(words)) == []


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (
            "shape: {kind: plane}, fixed: §false",
            f"fixed: {PLACE} is a plane; planes are always fixed",
        ),
        (
            "shape: {kind: plane}, §kinematic: true",
            f"kinematic: {PLACE} is a plane; planes are always fixed",
        ),
        (
            "shape: {kind: plane}, §position: [0, 0, 1]",
            f"position: {PLACE} is a plane; a plane has no position; "
            "its normal and offset say where it is",
        ),
        (
            "shape: {kind: plane}, §angular_velocity: [0, 0, 1]",
            f"angular_velocity: {PLACE} is a plane; a plane has no angular velocity",
        ),
        (
            f"{SPHERE}, position: [0, 0, 9], fixed: true, §velocity: [1, 0, 0]",
            f"velocity: {PLACE} is fixed; {FIXED} velocity",
        ),
        (
            f"{SPHERE}, position: [0, 0, 9], §mass: 1, fixed: true",
            f"mass: {PLACE} is fixed; {FIXED} mass",
        ),
        (
            f"{SPHERE}, position: [0, 0, 9], kinematic: true, §density: 1",
            f"density: {PLACE} is kinematic; a kinematic body has no density",
        ),
        (
            f"{SPHERE}, position: [0, 0, 9], fixed: true, §kinematic: true",
            f"{PLACE} specifies both fixed and kinematic; keep one",
        ),
        (
            f"{SPHERE}, fixed: true, §release: {{above: it, clearance: 1}}",
            f"release: {PLACE} is fixed and stays; specify its position",
        ),
        (
            f"{SPHERE}, position: [0, 0, 9], mass: 1, §density: 1",
            f"{PLACE} specifies both mass and density; keep one",
        ),
        (
            f"{SPHERE}, position: [0, 0, 9], mass: 1, inertia: [1, §3.01, 2]",
            "inertia: no body has a moment above the sum of the other two, found 3.01",
        ),
    ],
)
def test_what_a_body_cannot_have_is_refused_where_it_stands(words: str, sentence: str) -> None:
    found = with_body(words)
    if "above: it" in words:  # a release has rules of its own beside this one
        assert any(line.endswith(sentence) for line in refusals(found.replace("§", "")))
    else:
        assert_refused(found, sentence)


def test_a_movable_body_needs_a_mass_and_a_place() -> None:
    found = refusals(with_body(SPHERE))
    assert [line.split(": ", 1)[1] for line in found] == [
        f'missing key "position" in {PLACE}: [m], or a release above a plane',
        f'missing key "mass" in {PLACE}: [kg], or a density [kg/m^3], or fixed: true',
    ]


def test_a_misspelt_key_is_the_only_defect() -> None:
    assert_refused(
        with_body(f"{SPHERE}, position: [0, 0, 9], §masss: 1"),
        f'unknown key "masss" in {PLACE}; did you mean "mass"?',
    )


def test_moments_of_a_hull_come_from_its_shape() -> None:
    points = "[[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]"
    assert_refused(
        with_body(
            f"shape: {{kind: hull, points: {points}}}, position: [0, 0, 9], mass: 1, "
            "§inertia: [1, 1, 1]"
        ),
        f"inertia: {PLACE} is a hull; its shape says it, leave it out",
    )
