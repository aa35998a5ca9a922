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
from collections.abc import Callable, Iterable, Iterator, Sequence
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
from lavendersim.runner import cell_jobs, run
from lavendersim.runner.checks import check
from lavendersim.runner.log_size import expected_log_sizes
from lavendersim.runner.planning import Planned, planned
from lavendersim.runner.plans import distinct, shared_plans
from lavendersim.scene.explanation import explain_all
from lavendersim.scene.plan import Plan, union
from tests.many_keys_config import MANY_KEYS
from tests.many_measures_config import MANY_MEASURES

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


class End(NamedTuple):
    """What became of a text: in one word, and where that is a defect, how."""

    kind: str  # refused, complete, ended early, DEFECT
    detail: str = ""


def texts() -> dict[str, str]:
    """Return the configs whose numbers are replaced, by their names."""
    names = " ".join(OF_CONFIGS).split()
    found = {name: (CONFIGS / f"{name}.yaml").read_text(encoding="utf-8") for name in names}
    # all measures, and what those leave at its default
    return found | {"many measures": MANY_MEASURES, "many keys": MANY_KEYS}


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

    def planned_wide(cells: Sequence[Cell], source: str, workers: int) -> Planned:
        return planned(cells, source, workers)._replace(plans=wide(cells))

    few = property(lambda cell: min(STEPS, STEPS_OF(cell)))
    with (
        mock.patch.object(cell_jobs, "planned", planned_wide),
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
