"""`lavender run --watch`: again after every save, whatever became of the run before."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from lavender_cli import watch
from lavender_cli.main import app
from lavendersim.errors import ConfigError, Defect
from lavendersim.runner import watched_files

CONFIG = """\
scene:
  gravity: [0, 0, -10]
  bodies:
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [0, 0, 0]}
numerics: {timestep: 1/100}
duration: 0.1
measure: {fall: {kind: position, body: ball, along: [0, 0, 1]}}
expect: [{name: fall, measure: fall, between: [-0.06, -0.04]}]
"""


class NoMoreSavesError(Exception):
    """Ends what would go on until Ctrl-C."""


def test_a_config_is_run_again_when_it_is_saved(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A run that fails and a config that is wrong end no watching."""
    config = tmp_path / "fall.yaml"
    config.write_text(CONFIG)
    texts = [CONFIG.replace("-10]", "-20]"), CONFIG.replace("duration", "duraton")]

    def save(seconds: float) -> None:
        if not texts:
            raise NoMoreSavesError
        config.write_text(texts.pop(0) + "\n" * len(texts))

    monkeypatch.setattr(watched_files.time, "sleep", save)
    words = ["run", str(config), "--watch", "--runs", str(tmp_path / "runs")]
    result = CliRunner().invoke(app, words, catch_exceptions=True)
    assert isinstance(result.exception, NoMoreSavesError)
    assert re.findall(r"^  (pass|FAIL) +fall", result.output, re.MULTILINE) == ["pass", "FAIL"]
    assert 'did you mean "duration"' in result.output
    assert result.output.count("watching 1 file; Ctrl-C ends it") == 3


def test_exit_codes_and_errors_end_no_watching(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    ends = [typer.Exit(1), typer.Exit(3), ConfigError([Defect("a.yaml", 1, 2, "is wrong")])]
    monkeypatch.setattr(watched_files, "saves", lambda configs: iter(range(len(ends) + 1)))

    def once() -> None:
        if ends:
            raise ends.pop(0)

    watch.again([tmp_path], once)
    assert ends == []
    assert "a.yaml:1:2: is wrong" in capsys.readouterr().err


@pytest.mark.parametrize("option", [["--resume"], ["--into", "d"]])
def test_parts_of_runs_are_not_watched(tmp_path: Path, option: list[str]) -> None:
    result = CliRunner().invoke(app, ["run", str(tmp_path), "--watch", *option])
    assert result.exit_code == 2
    assert option[0] in result.output
