"""Which scenes have no depth in closed form, and which no overlap that is looked for."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from lavendersim.experiment import load_experiment_text
from lavendersim.measures.interfaces import Trace
from lavendersim.measures.overlap_of_bodies import overlap_of_rows, unknown_overlap

SHAPES = {
    "ball": "{kind: sphere, radius: 1}",
    "box": "{kind: box, size: [1, 1, 1]}",
    "bar": "{kind: cylinder, radius: 1, length: 1}",
    "pill": "{kind: capsule, radius: 1, length: 1}",
    "hull": "{kind: hull, points: [[0,0,0],[1,0,0],[0,1,0],[0,0,1]]}",
}


@pytest.mark.parametrize(
    ("names", "why"),
    [
        (("ball", "box"), ""),
        (("ball", "pill"), ""),
        (("bar",), ""),  # with planes it has one
        (("bar", "ball"), "no closed form for the depth of sphere and cylinder"),
        (("bar", "bar"), "no closed form for the depth of cylinder and cylinder"),
        (("box", "pill"), "no closed form for the depth of box and capsule"),
        (("hull",), "no closed form for the depth of a hull"),
    ],
)
def test_the_first_pair_without_a_closed_form_is_named(names: tuple[str, ...], why: str) -> None:
    bodies = "\n".join(
        f"    b{k}: {{shape: {SHAPES[name]}, mass: 1, position: [{9 * k}, 0, 5]}}"
        for k, name in enumerate(names)
    )
    text = f"scene:\n  bodies:\n    floor: {{shape: {{kind: plane}}}}\n{bodies}\nduration: 1\n"
    config = load_experiment_text(text, "pairs.yaml").cells()[0].config
    assert unknown_overlap(config.scene) == why


def trace_of(cell: str, bodies: dict[str, str], places: np.ndarray) -> Trace:
    """Return as much of a log as the depths are taken from; places: (steps, bodies, 3)."""
    lines = "\n".join(f"    {name}: {{{one}, mass: 1}}" for name, one in bodies.items())
    text = f"scene:\n  gravity: 0\n  periodic: {cell}\n  bodies:\n{lines}\nduration: 1\n"
    config = load_experiment_text(text, "cell.yaml").cells()[0].config
    pose = np.concatenate([places, np.ones((*places.shape[:2], 1))], axis=-1)
    pose = np.concatenate([pose, np.zeros((*places.shape[:2], 3))], axis=-1)
    return SimpleNamespace(config=config, bodies=list(bodies), pose=pose)  # type: ignore[return-value]


@pytest.mark.parametrize("periods", [0, -3])
def test_two_that_meet_across_a_face_overlap(periods: int) -> None:
    """Balls of 0.1 m at 0.05 and 1.95 m of a cell of 2 m: 0.1 m deep, and 1.7 m apart in it."""
    ball = "shape: {kind: sphere, radius: 0.1}, position: [%s, 0, 0]"
    places = np.array([[[0.05, 0.0, 0.0], [1.95 + 2.0 * periods, 0.0, 0.0]]])
    trace = trace_of("{x: [0, 2]}", {"a": ball % 0.05, "b": ball % 1.95}, places)
    # Places of 5 m have a last digit of 9e-16 m.
    np.testing.assert_allclose(overlap_of_rows(trace, [0]), 0.1, rtol=0.0, atol=4e-15)


def test_a_box_and_a_ball_meet_across_an_edge_of_the_cell() -> None:
    """One reaches across the face of x alone, the other across that of y alone."""
    bodies = {
        "ball": "shape: {kind: sphere, radius: 0.1}, position: [1.95, 0.11, 0.31]",
        "box": "shape: {kind: box, size: [0.4, 0.4, 0.4]}, position: [0.21, 1.95, 0]",
    }
    # Where its image meets it the ball's centre is 0.06 m beside the box, and 0.025 m above:
    # 0.065 m away. 0.0801 m above it is more than its radius away.
    places = np.array([[[1.95, 0.11, z], [0.21, 1.95, 0.0]] for z in (0.225, 0.2801)])
    trace = trace_of("{x: [0, 2], y: [0, 2]}", bodies, places)
    np.testing.assert_allclose(overlap_of_rows(trace, [0, 1]), [0.035, 0.0], rtol=0.0, atol=1e-15)


def test_of_many_balls_the_deepest_of_all_images_is_found() -> None:
    """Against brute force over 125 images of every ball, from places periods away."""
    draw = np.random.default_rng(7)
    periods, low, count = np.array([1.0, 1.2, 1.5]), np.array([-0.3, 0.0, 2.0]), 5
    radius = draw.uniform(0.05, 0.24, count)
    bodies = {
        f"b{k}": f"shape: {{kind: sphere, radius: {r!r}}}, position: [{9 * k}, 0, 0]"
        for k, r in enumerate(radius.tolist())
    }
    ends = [f"{axis}: [{a}, {a + p}]" for axis, a, p in zip("xyz", low, periods, strict=True)]
    places = draw.uniform(-1.0, 3.0, (200, count, 3))
    found = overlap_of_rows(trace_of(f"{{{', '.join(ends)}}}", bodies, places), range(200))
    apart = places[:, :, None] - places[:, None, :]
    apart -= periods * np.round(apart / periods)  # |n| <= 1/2; two more images on either side
    steps = np.stack(np.meshgrid(*[np.arange(-2, 3)] * 3, indexing="ij"), -1).reshape(-1, 3)
    distance = np.linalg.norm(apart[..., None, :] + steps * periods, axis=-1).min(-1)
    depth = radius[:, None] + radius - distance
    depth[:, np.arange(count), np.arange(count)] = 0.0
    expected = np.maximum(depth.max((1, 2)), 0.0)
    assert 50 < np.count_nonzero(expected) < 200
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-14)
