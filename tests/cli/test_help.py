"""Every verb says how it is used, with whichever typer and click are installed."""

from __future__ import annotations

import pytest
import typer
from typer.testing import CliRunner

from lavender_cli.main import app

VERBS = sorted(typer.main.get_command(app).commands)  # type: ignore[attr-defined]


def test_there_are_verbs() -> None:
    assert {"run", "check", "plan", "show", "replay", "cost"} <= set(VERBS)


@pytest.mark.parametrize("verb", VERBS)
def test_a_verb_prints_its_usage_and_every_option(verb: str) -> None:
    done = CliRunner().invoke(app, [verb, "--help"], env={"COLUMNS": "300", "NO_COLOR": "1"})
    assert done.exit_code == 0, done.output
    assert verb in done.output
    command = typer.main.get_command(app).commands[verb]  # type: ignore[attr-defined]
    shown = [one for one in command.params if not getattr(one, "hidden", False)]
    options = [option for one in shown for option in one.opts if option.startswith("--")]
    assert [option for option in options if option not in done.output] == []
