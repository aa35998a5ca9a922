"""An engine that is not installed is refused where the config names it, before anything runs."""

from __future__ import annotations

import pytest

from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment_text
from lavendersim.peers import catalogue
from lavendersim.runner.checks import check
from tests.engines import BALL

SWEPT = "sweep: {engine: {path: engine, values: [lavender, mujoco, mujoco-stiff]}}\n"


@pytest.mark.parametrize(
    ("lines", "place"), [("engine: mujoco\n", "8:1"), (SWEPT, "8:51"), (SWEPT, "8:59")]
)
def test_it_is_refused_at_its_name_with_the_command(
    lines: str, place: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    experiment = load_experiment_text(BALL + lines, "ball.yaml")
    monkeypatch.setattr(catalogue, "installed_version", lambda name: "")
    with pytest.raises(ConfigError) as refused:
        check(experiment)
    said = f"ball.yaml:{place}: engine: MuJoCo is not installed: "
    assert any(str(one).startswith(said) for one in refused.value.defects), refused.value
    assert all("`pip install mujoco`" in one.message for one in refused.value.defects)
