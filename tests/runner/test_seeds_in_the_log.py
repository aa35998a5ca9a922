"""The log names the seed of every scene in which something was drawn at random."""

from __future__ import annotations

from pathlib import Path

import lavendersim
from lavendersim.experiment import load_experiment_text
from lavendersim.runner.seeds import NONE, Seeds

CLOUD = """\
scene:
  gravity: 0
  bodies: {}
  arrangements:
    dust: {kind: grid, counts: [2, 1, 1], spacing: [1, 1, 1], jitter: 0.1, seed: 7, body: BALL}
    rain: {kind: grid, counts: [1, 1, 1], spacing: [1, 1, 1], origin: [0, 5, 0], body: BALL}
numerics: chapter
duration: 0.05
""".replace("BALL", "{shape: {kind: sphere, radius: 0.1}, mass: 1.0}")
SEED = "{path: scene.arrangements.dust.seed, values: [3, 4]}"
JITTER = "{path: scene.arrangements.rain.jitter, values: [0, 0.2]}"
GRAVITY = "{path: scene.gravity, values: [1]}"


def seeds(text: str) -> list[str]:
    experiment = load_experiment_text(text, "cloud.yaml")
    found = Seeds(experiment)
    return [found.of(cell) for cell in experiment.cells()]


def test_an_arrangement_that_is_jittered_has_its_seed_named() -> None:
    assert seeds(CLOUD) == ["dust: 7"]


def test_without_jitter_nothing_is_drawn() -> None:
    assert seeds(CLOUD.replace("jitter: 0.1, ", "")) == [NONE]
    assert seeds(CLOUD.replace("jitter: 0.1, ", "jitter: 0, ")) == [NONE]


def test_a_seed_that_is_not_specified_is_the_default() -> None:
    assert seeds(CLOUD.replace("seed: 7, ", "")) == ["dust: 0"]


def test_swept_seeds_and_jitters_are_those_of_the_cell() -> None:
    assert seeds(CLOUD + f"sweep: {{s: {SEED}}}\n") == ["dust: 3", "dust: 4"]
    assert seeds(CLOUD + f"sweep: {{j: {JITTER}}}\n") == ["dust: 7", "dust: 7, rain: 0"]


def test_a_product_without_the_axis_has_the_seed_as_written() -> None:
    text = CLOUD + f"sweep: [{{s: {SEED}}}, {{g: {GRAVITY}}}]\n"
    assert seeds(text) == ["dust: 3", "dust: 4", "dust: 7"]


def test_the_seed_stands_in_the_log(tmp_path: Path) -> None:
    finished = lavendersim.run(load_experiment_text(CLOUD, "cloud.yaml"), root=tmp_path)
    assert finished.run.cells[0].trace().metadata["engine"]["seed"] == "dust: 7"
