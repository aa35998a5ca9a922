"""A spelling that was renamed is read for one version, with a warning that names the new one."""

from __future__ import annotations

import os
import subprocess
import sys
import warnings
from pathlib import Path

import pytest

from lavendersim.errors import ConfigError, ConfigWarning
from lavendersim.experiment import load_experiment_text

BALL = "scene: {bodies: {ball: {shape: {kind: sphere, radius: 1}, mass: 1, position: [0, 0, 9]}}}\n"
DURATION = "duration: 1\n"


def messages(text: str) -> list[str]:
    """Return the warnings that a config is read with."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        load_experiment_text(text, "old.yaml")
    return [str(one.message) for one in caught if one.category is ConfigWarning]


def test_a_former_key_is_read_and_its_new_name_is_said_at_its_place() -> None:
    said = messages(BALL + DURATION + "price: {repeats: 3}\n")
    assert said == [
        'old.yaml:3:1: key "price" is called "overhead" now; the next version refuses the former '
        "name"
    ]
    with pytest.warns(ConfigWarning):
        experiment = load_experiment_text(BALL + DURATION + "price: {repeats: 3}\n", "old.yaml")
    assert experiment.config.overhead is not None
    assert experiment.config.overhead.repeats == 3


def test_a_former_key_in_a_section_and_a_former_kind_are_read() -> None:
    text = (
        f"{BALL}{DURATION}measure:\n  n: {{kind: unsolved_steps}}\n"
        "cost: {error: {measure: n, scale: 1}, unsolved: 0.5}\n"
    )
    assert [one.split(";")[0] for one in messages(text)] == [
        'old.yaml:5:39: key "unsolved" is called "not_converged" now',
        'old.yaml:4:13: kind "unsolved_steps" is called "not_converged_steps" now',
    ]


def test_this_versions_spelling_warns_of_nothing() -> None:
    assert messages(BALL + DURATION + "overhead: {repeats: 3}\n") == []


@pytest.mark.filterwarnings("ignore::lavendersim.errors.ConfigWarning")
def test_both_spellings_in_one_file_are_refused_and_so_is_what_is_wrong_below_the_former() -> None:
    with pytest.raises(ConfigError, match='5:1: unknown key "price"'):
        load_experiment_text(f"{BALL}{DURATION}overhead: {{}}\n\nprice: {{}}\n", "old.yaml")
    with pytest.raises(ConfigError, match=r"3:18: repeats: expected a whole number"):
        load_experiment_text(f"{BALL}{DURATION}price: {{repeats: x}}\n", "old.yaml")


def test_the_command_line_shows_the_warning_as_one_line_on_stderr(tmp_path: Path) -> None:
    config = tmp_path / "old.yaml"
    config.write_text(f"{BALL}{DURATION}price: {{}}\n")
    command = "from lavender_cli.main import main; main()"
    done = subprocess.run(
        [sys.executable, "-c", command, "plan", str(config)],
        capture_output=True,
        text=True,
        check=False,
        env={key: value for key, value in os.environ.items() if key != "PYTHONWARNINGS"},
    )
    lines = [line for line in done.stderr.splitlines() if "old.yaml:3" in line]
    assert len(lines) == 1
    assert lines[0].startswith(f'{config}:3:1: key "price" is called "overhead" now')
