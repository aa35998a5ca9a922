"""Frictional scenes come out equal to the last bit: again, in other processes, from a compiled
kernel or a kept one, with one worker or two. The logs' bytes and the state's hash at every step are
compared between the runs of this session; no number is stored.

Three processes: one that finds no kernel and runs everything twice, one that finds the kernels, and
one with two workers. That an edited engine finds none of them is checked by `test_kernel_cache`.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from small_configs import write

from tests.forked_python import python
from tests.kept_kernels import of_scenes

# A box that lands on an edge, bounces, slides and tumbles, in the default numerics.
TUMBLE = """\
question: Does a tumbling box come out the same again?
expected: To the last bit.
scene:
  surfaces: {rubber: {friction: 0.4, restitution: 0.3}}
  bodies:
    floor: {shape: {kind: plane}, surface: rubber}
    box:
      shape: {kind: box, size: [0.3, 0.2, 0.1]}
      mass: 1.0
      surface: rubber
      position: [0, 0, 0.3]
      velocity: [1, 0.5, -1]
      angular_velocity: [3, 5, 1]
numerics: {timestep: 1/240}
duration: 0.5
sweep:
  spin: {path: scene.bodies.box.angular_velocity.0, values: [3, 7, 11]}
measure:
  gain: {kind: energy_gain}
expect:
  - {name: runs, measure: gain, at_most: 1}
"""
# 36 spheres: 630 pairs with each other, more than are looked at one by one.
PILE = """\
question: Does a pile come out the same again?
expected: To the last bit.
scene:
  surfaces: {rubber: {friction: 0.5, restitution: 0.2}}
  bodies:
    floor: {shape: {kind: plane}, surface: rubber}
  arrangements:
    ball:
      kind: grid
      counts: [3, 3, 4]
      spacing: [0.11, 0.11, 0.11]
      origin: [0, 0, 0.1]
      jitter: 0.01
      seed: 1
      body: {shape: {kind: sphere, radius: 0.05}, mass: 1.0, surface: rubber}
numerics: chapter
duration: 0.5
sweep:
  e: {path: scene.surfaces.rubber.restitution, values: [0.2, 0.4, 0.6]}
measure:
  gain: {kind: energy_gain}
expect:
  - {name: runs, measure: gain, at_most: 1}
"""
# Prints, as the last line, what each config's run gave: argv is root, workers, how often, configs.
RUN = """
import json, sys
from hashlib import sha256
from pathlib import Path
import lavendersim
from lavendersim.runner.plans import shared_plans

def main():
    root, workers, times = Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3])
    found = []
    for k in range(times):
        runs = []
        for config in sys.argv[4:]:
            folder = root / f"{k}-{Path(config).stem}"
            cells = lavendersim.run(Path(config), root=folder, jobs=workers).run.cells
            contacts = [int(cell.trace().step["contact_count"].sum()) for cell in cells]
            hashes = [cell.trace().step["state_hash"].tolist() for cell in cells]
            logs = [sha256(cell.path.read_bytes()).hexdigest() for cell in cells]
            plans = [plan.spec.effects for plan in shared_plans(
                lavendersim.load_experiment(Path(config)).cells())]
            runs.append({"logs": logs, "hashes": hashes, "contacts": contacts,
                         "effects": plans[0]})
        found.append(runs)
    print(json.dumps(found))

if __name__ == "__main__":
    main()
"""


class Scenes:
    """The two configs and a folder of kernels that starts empty."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.kernels = folder / "kernels"
        texts = {"tumble.yaml": TUMBLE, "pile.yaml": PILE}
        self.configs = [write(folder, text, name) for name, text in texts.items()]
        self.script = write(folder, RUN, "run_scenes.py")
        self.calls = 0

    def written(self) -> dict[Path, int]:
        """Return when each kernel was written [ns]."""
        return {path: path.stat().st_mtime_ns for path in of_scenes(self.kernels)}

    def run(self, workers: int = 1, times: int = 1) -> Any:
        """Return, per time and config, what a new process makes of them."""
        self.calls += 1
        runs = self.folder / f"runs-{self.calls}"
        # A script, not `-c`: workers of a pool import the main module.
        words = (self.script, runs, workers, times, *self.configs)
        done = python(*words, LAVENDER_CACHE_DIR=str(self.kernels))
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout.strip().splitlines()[-1])


@pytest.fixture(scope="module")
def scenes(tmp_path_factory: pytest.TempPathFactory) -> Scenes:
    return Scenes(tmp_path_factory.mktemp("scenes"))


@pytest.fixture(scope="module")
def compiled(scenes: Scenes) -> Any:
    """What the process that compiled the kernels gave, the first time and the second."""
    assert not scenes.kernels.exists()
    found = scenes.run(times=2)
    assert len(of_scenes(scenes.kernels)) == len(scenes.configs)
    return found


def test_scenes_hold_what_they_are_to_prove(compiled: Any) -> None:
    tumble, pile = compiled[0]
    assert {"friction", "restitution", "impact_time"} <= set(tumble["effects"])
    assert {"friction", "restitution", "broad_phase"} <= set(pile["effects"])
    for scene in (tumble, pile):
        assert min(scene["contacts"]) > 50
        for hashes in scene["hashes"]:
            assert len(hashes) == len(set(hashes)) == 121  # every state its own
        assert len(set(scene["logs"])) == 3


def test_the_same_process_gives_the_same_bits_again(compiled: Any) -> None:
    assert compiled[1] == compiled[0]


def test_a_process_that_finds_the_kernels_gives_the_same_bits(
    scenes: Scenes, compiled: Any
) -> None:
    written = scenes.written()
    assert scenes.run() == compiled[:1]
    assert scenes.written() == written


def test_two_workers_give_the_same_bits(scenes: Scenes, compiled: Any) -> None:
    written = scenes.written()
    assert scenes.run(workers=2) == compiled[:1]
    assert scenes.written() == written
