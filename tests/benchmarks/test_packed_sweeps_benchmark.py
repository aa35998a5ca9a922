"""The benchmark of packed sweeps times both engines of a scene and holds its bars. No limits."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.benchmarks import packed_sweeps
from tests.benchmarks.as_process import benchmark


def test_both_engines_of_every_scene_are_timed(tmp_path: Path) -> None:
    output = tmp_path / "packed.json"
    # Spheres alone: an engine of boxes takes four times as long to compile.
    size = ["--layers", "1", "--bases", "--steps", "20", "--surfaces", "frictional"]
    done = benchmark("packed_sweeps", *size, "--output", str(output))
    assert done.returncode == 0, done.stderr
    rows = {row["scene"]: row for row in json.loads(output.read_text())["scenes"]}
    assert {scene: row["bodies"] for scene, row in rows.items()} == {"frictional pile": 40}
    for row in rows.values():
        assert row["with"]["us_per_step"] > 0.0
        assert row["ratio"] == pytest.approx(
            row["with"]["us_per_step"] / row["without"]["us_per_step"]
        )
        assert f"{row['ratio']:6.2f}" in done.stdout


def test_surfaces_of_a_pile_are_those_that_were_asked_for() -> None:
    def effects(surface: str) -> set[str]:
        text = packed_sweeps.text_of("pile", 1, surface)
        return {*packed_sweeps.case(text, record=False).plan.spec.effects}

    frictional, frictionless = effects("frictional"), effects("frictionless")
    assert "friction" in frictional - frictionless
    turning = {"torsional_friction", "rolling_friction"}
    assert effects("turning") & turning == turning
    assert not frictional & turning


@pytest.mark.parametrize(
    ("bodies", "ratio", "exit_code"), [(200, 0.91, 1), (200, 0.89, 0), (199, 0.91, 0)]
)
def test_a_scene_that_the_plan_packs_and_that_gains_nothing_fails_the_check(
    bodies: int, ratio: float, exit_code: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    taken = {"us_per_step": 1.0, "residual": 0.0, "overlap": 0.0}
    row = {"scene": "pile", "bodies": bodies, "contacts": 8, "bar": packed_sweeps.BAR["pile"]}
    row |= {"ratio": ratio, "without": taken, "with": taken}
    found = {"scenes": [row], "steps": 1, "environment": {"processor": "one", "cores": 1}}
    monkeypatch.setattr(packed_sweeps, "measure_all", lambda *sizes: found)
    monkeypatch.setattr("sys.argv", ["packed_sweeps", "--check"])
    assert packed_sweeps.main() == exit_code
    monkeypatch.setattr("sys.argv", ["packed_sweeps"])
    assert packed_sweeps.main() == 0
