"""What the player of a page plays: sampled poses, and outlines equal to those of the thumbnail."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lavendersim.figures.html_page import PLAYER
from lavendersim.figures.motion import FRAMES, motion
from lavendersim.figures.thumbnail import _outlines, view_of
from lavendersim.runner import run

SCENE = """\
scene:
  bodies:
    floor: {shape: {kind: plane}}
    wall: {shape: {kind: box, size: [0.1, 1, 1]}, fixed: true, position: [1, 0, 0.5]}
    box:
      shape: {kind: box, size: [0.2, 0.3, 0.4]}
      mass: 1
      position: [0, 0, 2]
      angular_velocity: [1, 2, 3]
    bar:
      shape: {kind: capsule, radius: 0.1, length: 0.5}
      mass: 1
      position: [0.3, 0.5, 3]
      angular_velocity: [3, 0, 1]
numerics: chapter
duration: 0.3
"""


@pytest.fixture(scope="module")
def trace(tmp_path_factory: pytest.TempPathFactory) -> Any:
    folder = tmp_path_factory.mktemp("motion")
    config = folder / "thrown.yaml"
    config.write_text(SCENE)
    return run(config, folder / "runs").run.cells[0].trace()


def test_first_and_last_state_are_played_and_not_too_many_between(trace: Any) -> None:
    played = json.loads(motion(trace))
    assert played["t"][0] == 0.0
    assert played["t"][-1] == pytest.approx(0.3)
    assert len(played["t"]) <= FRAMES
    assert np.all(np.diff(played["t"]) > 0.0)
    wall, box, bar = played["bodies"]
    assert wall["fixed"]
    assert len(wall["p"]) == 1
    assert len(box["p"]) == len(bar["p"]) == len(played["t"])
    # g t^2 / 2 after 0.3 s; four digits of the room of bodies, which is a metre
    assert box["p"][-1][2] == pytest.approx(2.0 - 0.5 * 9.81 * 0.09, abs=0.02)
    (ground,) = played["grounds"]
    assert np.dot(ground[0], [0, 0, 1]) == 0.0


def test_no_text_can_end_its_element(trace: Any) -> None:
    assert "<" not in motion(trace)


@pytest.mark.skipif(shutil.which("node") is None, reason="no node here runs the player's script")
def test_the_player_draws_what_the_thumbnail_does(trace: Any, tmp_path: Path) -> None:
    """The script turns corners by quaternions, the thumbnail by matrices."""
    script = tmp_path / "outlines.js"
    player = tmp_path / "player.js"
    player.write_text(PLAYER.read_text("utf-8"))
    script.write_text(
        f"const player = require({json.dumps(str(player))}), data = {motion(trace)};"
        "const axes = player.axesOf(data, 0, 0), last = data.t.length - 1;"
        "const turned = player.axesOf(data, 0.7, -0.4);"
        "console.log(JSON.stringify([player.outlines(data, last, axes), axes, turned]));"
    )
    done = subprocess.run(["node", script], capture_output=True, text=True, check=True)
    found, axes, turned = json.loads(done.stdout)
    right, up = view_of(trace)
    expected, colours, _ = _outlines(trace, right, up)
    ended = [one for one in zip(expected, colours, strict=True) if one[1] != "#e8e8e8"]
    assert [one["colour"] for one in found] == [colour for _, colour in ended]
    for one, (outline, _) in zip(found, ended, strict=True):
        # poses have four digits of the room, which is some two metres; near corners may join
        for points, others in ((np.array(one["points"]), outline), (outline, one["points"])):
            apart = np.linalg.norm(points[:, None] - np.asarray(others)[None], axis=2)
            assert apart.min(axis=1).max() < 2e-3
    for view in (axes, turned):
        frame = np.array([view["right"], view["up"], view["away"]])
        assert frame @ frame.T == pytest.approx(np.eye(3), abs=1e-12)


class Repeated:
    """A log whose scene is periodic along x."""

    def __init__(self, trace: Any) -> None:
        self._trace = trace
        scene = trace.config.scene
        cell = SimpleNamespace(x=(-4.0, 6.0), y=None, z=None)
        repeated = SimpleNamespace(bodies=scene.bodies, gravity=scene.gravity, periodic=cell)
        self.config = SimpleNamespace(scene=repeated, planned_events=())

    def __getattr__(self, name: str) -> Any:
        return getattr(self._trace, name)


def test_a_periodic_cell_is_played_by_its_edges_and_is_in_the_room(
    trace: Any, tmp_path: Path
) -> None:
    assert json.loads(motion(trace))["cell"] == []
    text = motion(Repeated(trace))
    edges = np.array(json.loads(text)["cell"])
    assert edges.shape == (12, 2, 3)
    assert [edges[..., 0].min(), edges[..., 0].max()] == [-4.0, 6.0]
    # Along y what moves, 0.35 m about 0.5 m, and the wall, 0.71 m about 0; three digits of 2 m.
    assert [edges[..., 1].min(), edges[..., 1].max()] == pytest.approx([-0.709, 0.85], abs=2e-3)
    if shutil.which("node") is not None:
        script = tmp_path / "room.js"
        (tmp_path / "player.js").write_text(PLAYER.read_text("utf-8"))
        script.write_text(
            f'const player = require("./player.js"); const room = player.roomOf({text});'
            "console.log(JSON.stringify(room));"
        )
        done = subprocess.run(["node", script], capture_output=True, text=True, check=True)
        assert json.loads(done.stdout)["centre"][0] == pytest.approx(1.0)
