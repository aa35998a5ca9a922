"""`lavender judge --laws`: the law that a step breaks, of runs and of logs of other programs."""

from __future__ import annotations

import json
from pathlib import Path

from mcap.writer import Writer

from lavendersim import run
from tests.cli.command_line import lavender

CONFIG = """\
question: Is it held?
expected: By the floor.
scene:
  gravity: [0, 0, -10]
  bodies:
    floor: {shape: {kind: plane}}
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 2, position: [0, 0, 0.1]}
numerics: {timestep: 1/100}
duration: 0.05
"""
SCHEMAS = {"/tf": "foxglove.FrameTransforms", "/velocities": "lavender.Velocities"}


def log(path: Path, speed: float) -> Path:
    """Write a log of two states: a ball at rest, and with a speed along x that nothing gave it."""
    with path.open("wb") as stream:
        writer = Writer(stream)
        writer.start()
        writer.add_attachment(0, 0, "config.yaml", "application/yaml", CONFIG.encode())
        for topic, name in SCHEMAS.items():
            schema = writer.register_schema(name, "jsonschema", b"{}")
            channel = writer.register_channel(topic, "json", schema)
            for step in (0, 1):
                place = {"translation": {"z": 0.1}, "rotation": {"w": 1.0}}
                message = {
                    "/tf": {"transforms": [{"child_frame_id": "ball", **place}]},
                    "/velocities": {"bodies": [{"body": "ball", "velocity": {"x": step * speed}}]},
                }[topic]
                time = 10_000_000 * step
                writer.add_message(channel, time, json.dumps(message).encode(), time)
        writer.finish()
    return path


def test_a_log_of_another_program_is_judged(tmp_path: Path) -> None:
    """0.6 N s without a spin: friction, which the floor has none of, would give a part of it.

    At the lowest point an impulse across gives 1/m to the velocity and 2.5/m by the spin: the best
    leaves sqrt(2.5/3.5) of 0.6 N s, and is itself beyond the cone.
    """
    done = lavender("judge", log(tmp_path / "mine.mcap", 0.3), "--laws", where=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    lines = done.stdout.splitlines()
    assert lines[0] == "mine.mcap  1 steps"
    assert lines[-1].startswith("  broken most: momentum, by ")
    (momentum,) = [line for line in lines if line.startswith("  momentum ")]
    # sqrt(2.5/3.5) 0.6 N s, and over 2 kg
    assert "0.507093 N s (0.253546 m/s), ball, step 1, t = 0.01 s" in momentum


def test_as_json_with_every_step(tmp_path: Path) -> None:
    path = log(tmp_path / "mine.mcap", 0.0)
    done = lavender("judge", path, "--laws", "--json", "-v", where=tmp_path)
    (cell,) = json.loads(done.stdout)["cells"]
    assert (cell["cell"], cell["named"], cell["steps"]) == ("mine.mcap", None, 1)
    assert cell["step"] == [1]
    assert cell["numbers"]["momentum"][0] < 1e-15


def test_a_run_is_judged_by_its_cells(tmp_path: Path) -> None:
    (tmp_path / "rest.yaml").write_text(CONFIG + "record: {velocities: true}\n")
    run(tmp_path / "rest.yaml", root=tmp_path / "runs")
    done = lavender("judge", "--laws", where=tmp_path)
    assert done.stdout.count(" 5 steps") == 1
    assert "none of them is broken" in done.stdout


def test_a_run_without_velocities_says_so(tmp_path: Path) -> None:
    (tmp_path / "rest.yaml").write_text(CONFIG)
    run(tmp_path / "rest.yaml", root=tmp_path / "runs")
    done = lavender("judge", "--laws", where=tmp_path)
    assert done.returncode == 2
    assert "record.velocities is false" in done.stderr


def test_a_log_that_is_none_is_damaged(tmp_path: Path) -> None:
    (tmp_path / "bad.mcap").write_bytes(b"no log")
    done = lavender("judge", "bad.mcap", "--laws", where=tmp_path)
    assert done.returncode == 3
    assert "damaged" in done.stderr
