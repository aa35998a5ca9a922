"""Numbers of configs replaced by doubles of any size, put to `check`, `plan` and ten steps.

    python -m tests.property.extreme_numbers --count 5000 [--seed 0]

A config with such a number is refused with file, line and column, or it runs to an end that has a
name. No traceback, no warning of numpy, and of a refused config nothing on the disk.
"""

from __future__ import annotations

import argparse
import re
import struct
import sys
import tempfile
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple
from unittest import mock

import numpy as np

from lavendersim.cell import CellConfig
from lavendersim.errors import ConfigError, ConfigWarning
from lavendersim.experiment import load_experiment_text
from lavendersim.experiment.cell import Cell
from lavendersim.experiment.text.node import Node
from lavendersim.experiment.text.parse import parse
from lavendersim.experiment.text.report import Report
from lavendersim.runner import run
from lavendersim.runner.checks import check
from lavendersim.runner.log_size import expected_log_sizes
from lavendersim.runner.plans import distinct, shared_plans
from lavendersim.scene.explanation import explain_all
from lavendersim.scene.plan import Plan, union

CONFIGS = Path(__file__).parents[2] / "configs"
STEPS = 10
STEPS_OF = CellConfig.steps.fget  # type: ignore[attr-defined]
SLOWEST = 600.0  # [s] of one text, with kernels that are compiled for it on a busy machine
NAME = "extreme.yaml"
PLACE = re.compile(re.escape(NAME) + r":[1-9]\d*:[1-9]\d*: ")
TOKEN = re.compile(r"[-+]?[0-9.][0-9.eE+/-]*")
# Where formulas turn: the ends of the doubles, of their squares and cubes, of whole numbers.
TURNS = (
    *("5e-324", "2.2250738585072014e-308", "1.7976931348623157e308", "1e308", "1e-308", "0"),
    *("1e154", "1.4e154", "1e-154", "1e-162", "1e103", "1e-108", "1e77", "1e-77", "1e200"),
    *("1e-200", "1e300", "1e-300", "9007199254740993", "9223372036854775808", "1e19", "1e16"),
    *("-1", "-1e300", "-5e-324", "-0.0", "1/3", "1e9", "1e-9", "2147483648", "1/1000000007"),
)
OF_CONFIGS = (
    "effects/carried effects/cohesion effects/spring effects/static_friction scenes/incline",
    "scenes/rod_end scenes/stack_of_six scenes/free_rotation time/ball_on_springs",
    "time/accuracy_of_energy hard/friction/slide_and_twist hard/found/torque_beyond_its_cone",
    "hard/timestep/changes_during_the_run hard/mass_ratio/brick_on_brick chapter/warm_start",
)
# What the shipped configs above leave at its default.
MANY_KEYS = """\
question: What if?
scene:
  gravity: {magnitude: 9.81, slope: 0.1, azimuth_degrees: 45}
  surfaces:
    rubber: {restitution: 0.8, compliance: 1e-6, friction: 0.3, damping_ratio: 0.1, cohesion: 0.01}
  bodies:
    floor: {shape: {kind: plane, normal: [0, 0, 1], offset: 0.5}}
    ball:
      shape: {kind: sphere, radius: 0.1}
      mass: 1.0
      inertia: [0.1, 0.2, 0.25]
      surface: rubber
      release: {above: floor, clearance: 0.002, phase: 0.2, at: [0.1, 0.2]}
      orientation: {axis: [0, 0, 1], degrees: 30}
      drag: {linear: 0.1, quadratic: 0.2, angular: 0.1}
    block: {shape: {kind: box, size: [1, 1, 1]}, density: 10, position: [5, 0, 1]}
    rock:
      shape: {kind: hull, points: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0.1, 0.1, 0.1]]}
      density: 10
      release: {above: floor, clearance: 0.5, at: [9, 9]}
    thing:
      shape:
        kind: compound
        parts:
          - {shape: {kind: capsule, radius: 0.1, length: 0.3}, position: [0.1, 0, 0]}
          - {shape: {kind: cylinder, radius: 0.1, length: 0.3}, orientation: [1, 1, 0, 0]}
      mass: 2.0
      position: [7, 0, 1]
    belt:
      shape: {kind: box, size: [1, 1, 1]}
      kinematic: true
      position: [0, 9, 0]
      surface_velocity: [0.1, 0.1, 0]
  arrangements:
    tower:
      {kind: tower, count: 2, base: [4, 4, 0.5], gap: 0.001,
      body: {shape: {kind: box, size: [1, 1, 1]}, mass: 1}}
    heap:
      {kind: grid, counts: [2, 2, 1], spacing: [1, 1, 1], jitter: 0.1, seed: 3, origin: [20, 0, 2],
      body: {shape: {kind: sphere, radius: 0.1}, mass: 1, surface: rubber}}
    pyramid:
      {kind: pyramid, base_count: 2, gap: 0.1, base: [40, 0, 0.5],
      body: {shape: {kind: capsule, radius: 0.1, length: 0.4}, mass: 1}}
  springs:
    - {a: ball, b: block, stiffness: 10, damping: 0.1, rest_length: 0.5, point_a: [0.1, 0, 0]}
  forces:
    - {body: tower_2, from: 0.01, to: 0.02, force: [0.1, 0, 1], torque: [1, 0, 0.1]}
events:
  - {at: 0.02, body: ball, scale_mass: 1.05, contact_cache: keep}
  - {at: 0.03, body: belt, velocity: [1, 0, 0.1], angular_velocity: [0, 0.1, 1]}
  - {at: 0.03, body: thing, teleport: [7, 1, 1]}
numerics:
  {timestep: 1/240, sweeps: 20, over_relaxation: 1.1, tolerance: 1e-9, stabilisation_gain: 0.02,
  slop: 0.001, projection: 0.2, projection_sweeps: 22, restitution_threshold: 2,
  cache_distance: 0.02, cache_normal_cosine: 0.95, sleeping: true, sleep_speed: 0.005,
  sleep_time: 0.5}
duration: 1/24
record: {residuals: {from: 0.01, to: 0.02}, contacts: {from: 0.001, to: 0.04}}
always:
  {energy: none, penetration: none, impulses: none, momentum: none, residual: 1, speed: 1e9,
  stop: false}
measure:
  aside: {kind: displacement, body: block, from: 0.001, to: 0.02, along: [1, 0.1, 0]}
  energy: {kind: energy_drift}
expect:
  - {name: aside, measure: aside, equals: {value: 0, absolute: 1e-9}}
"""


class End(NamedTuple):
    """What became of a text: in one word, and where that is a defect, how."""

    kind: str  # refused, complete, ended early, DEFECT
    detail: str = ""


def texts() -> dict[str, str]:
    """Return the configs whose numbers are replaced, by their names."""
    names = " ".join(OF_CONFIGS).split()
    found = {name: (CONFIGS / f"{name}.yaml").read_text(encoding="utf-8") for name in names}
    return found | {"many keys": MANY_KEYS}


def numbers_of(text: str) -> list[tuple[int, int]]:
    """Return where the numbers of a config stand in its text: begin and end."""
    root = parse(text.encode(), Report(NAME))
    assert root is not None
    starts = np.cumsum([0, *(len(line) for line in text.splitlines(keepends=True))])
    places = []
    for node in _numbers(root):
        begin = int(starts[node.mark.line - 1]) + node.mark.column - 1
        token = TOKEN.match(text, begin)
        assert token is not None, text[begin : begin + 20]
        places.append(token.span())
    return places


def _numbers(node: Node) -> Iterator[Node]:
    if node.number is not None:
        yield node
    for below in (*node.entries.values(), *node.items):
        yield from _numbers(below)


def drawn(random: np.random.Generator) -> str:
    """Return a number: a turn of formulas, any double by its bits, or any magnitude."""
    which = int(random.integers(4))
    if which == 0:
        return str(random.choice(TURNS))
    if which == 1:
        number = struct.unpack("<d", random.bytes(8))[0]
        return repr(number) if np.isfinite(number) else "1.7976931348623157e308"
    sign = "-" if random.random() < 0.1 else ""
    limit = 307 if which == 2 else 30
    return f"{sign}{random.uniform(1, 10):.3g}e{int(random.integers(-limit, limit))}"


def mutations(count: int, seed: int, only: tuple[str, ...] = ()) -> Iterator[tuple[str, str, str]]:
    """Yield texts with one number replaced, each with its config and what was done."""
    random = np.random.default_rng(seed)
    known = {name: text for name, text in texts().items() if name in only or not only}
    places = {name: numbers_of(text) for name, text in known.items()}
    names = list(known)
    for number in range(count):
        name = names[-1] if number % 2 == 0 else names[int(random.integers(len(names)))]
        text = known[name]
        begin, end = places[name][int(random.integers(len(places[name])))]
        new = drawn(random)
        line = text[text.rfind("\n", 0, begin) + 1 : text.find("\n", end)].strip()
        yield name, f"{text[begin:end]} -> {new} in {line}", text[:begin] + new + text[end:]


def outcome(text: str, folder: Path, wide: Widening | None) -> End:
    """Put a text to `check`, `plan` and ten steps; `folder` is empty, and is again afterwards."""
    began = time.monotonic()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", ConfigWarning)
        try:
            end = _outcome(text, folder, wide)
        except ConfigError as error:
            bad = [str(one) for one in error.defects if not PLACE.match(str(one))]
            end = End("DEFECT", f"no place: {bad[0]}") if bad else End("refused", str(error))
            if list(folder.iterdir()):
                end = End("DEFECT", f"left behind: {list(folder.iterdir())}")
        except Exception:
            end = End("DEFECT", _last_lines(traceback.format_exc()))
    if (took := time.monotonic() - began) > SLOWEST and end.kind != "DEFECT":
        end = End("slow", f"{took:.1f} s, {end}")
    return end


def _last_lines(trace: str) -> str:
    """Return the place and the error of a traceback."""
    ours = [line.strip() for line in trace.splitlines() if "lavendersim/" in line]
    return " | ".join((*ours[-2:], trace.strip().splitlines()[-1]))


Widening = Callable[[Iterable[Cell]], list[Plan]]


class WidePlans:
    """Plans with every effect that the config before had with any number: few kernels compile."""

    def __init__(self) -> None:
        self._plans: dict[tuple[str, Any], Plan] = {}

    def of(self, name: str) -> Widening:
        """Return what takes the place of `shared_plans` for the texts of a config."""

        def wide(cells: Iterable[Cell]) -> list[Plan]:
            own = shared_plans(cells)
            for plan in distinct(own):
                key = name, plan.choices
                self._plans[key] = union([self._plans.get(key, plan), plan])
            return [self._plans[name, plan.choices] for plan in own]

        return wide


def _outcome(text: str, folder: Path, wide: Widening | None) -> End:
    experiment = load_experiment_text(text, NAME)
    check(experiment)
    cells = experiment.cells()
    plans = shared_plans(cells)
    explain_all(distinct(plans))
    expected_log_sizes(cells, plans, experiment.text)
    if wide is None:
        return End("complete")
    few = property(lambda cell: min(STEPS, STEPS_OF(cell)))
    with (
        mock.patch("lavendersim.runner.plans.shared_plans", wide),
        mock.patch.object(CellConfig, "steps", few),
    ):
        finished = run(experiment, folder, overheads=False)
    early = [cell.status for cell in finished.run.cells if cell.status != "complete"]
    return End("ended early", early[0]) if early else End("complete")


def counted(
    count: int, seed: int, only: tuple[str, ...] = (), *, steps: bool = True, shown: bool = False
) -> tuple[Counter[str], list[str]]:
    """Return how many texts came to which end, and what was done to those with a defect.

    only: of these configs; all if none. steps: false for `check` and `plan` alone, without kernels.
    """
    counts: Counter[str] = Counter()
    defects, plans = [], WidePlans()
    for name, what, text in mutations(count, seed, only):
        with tempfile.TemporaryDirectory() as folder:
            end = outcome(text, Path(folder), plans.of(name) if steps else None)
        counts[end.kind] += 1
        if end.kind in ("DEFECT", "slow"):
            defects.append(f"{name}: {what}: {end.detail}")
            if shown:
                print(defects[-1], flush=True)
    return counts, defects


def main() -> None:
    """Replace numbers, print each defect as it is found, and the counts; exit 1 with any."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=5000)
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()
    counts, defects = counted(asked.count, asked.seed, shown=True)
    print(", ".join(f"{kind}: {number}" for kind, number in sorted(counts.items())))
    sys.exit(1 if defects else 0)


if __name__ == "__main__":
    main()
