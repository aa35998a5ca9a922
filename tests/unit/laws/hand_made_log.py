"""A log written with the `mcap` library and nothing else, as another program would."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path

from mcap.writer import Writer

CONFIG = """\
question: Which law does my engine break?
expected: None.
scene:
  gravity: [0, 0, -10]
  bodies:
    floor: {shape: {kind: plane}, surface: {friction: 0.5}}
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 2, position: [0, 0, 0.1],
           surface: {friction: 0.5}}
numerics: {timestep: 1/100}
duration: 1
"""
Numbers = Iterable[float]


def write_log(
    path: Path,
    states: Iterable[tuple[int, Numbers, Numbers, Numbers]],
    *,
    config: str | None = CONFIG,
    body: str = "ball",
    schema: str = "lavender.Velocities",
) -> Path:
    """Write states: time [ns], place [m], velocity [m/s] and spin [rad/s] of the ball."""
    with path.open("wb") as stream:
        writer = Writer(stream)
        writer.start(profile="", library="my engine")
        if config is not None:
            writer.add_attachment(0, 0, "config.yaml", "application/yaml", config.encode())
        channels = {
            topic: writer.register_channel(
                topic, "json", writer.register_schema(name, "jsonschema", b"{}")
            )
            for topic, name in (("/tf", "foxglove.FrameTransforms"), ("/velocities", schema))
        }
        for time, place, velocity, spin in states:
            transform = {
                "parent_frame_id": "world",
                "child_frame_id": body,
                "translation": dict(zip("xyz", place, strict=True)),
                "rotation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0},
            }
            speeds = {
                "body": body,
                "velocity": dict(zip("xyz", velocity, strict=True)),
                "angular_velocity": dict(zip("xyz", spin, strict=True)),
            }
            for topic, data in (
                ("/tf", {"transforms": [transform]}),
                ("/velocities", {"bodies": [speeds]}),
            ):
                writer.add_message(channels[topic], time, json.dumps(data).encode(), time)
        writer.finish()
    return path
