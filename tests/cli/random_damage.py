"""Bits, cuts and exchanged chunks at random in logs, under every verb, the interface and pytest.

    python -m tests.cli.random_damage --flips 1000 --cuts 200 --exchanges 50

Of each damaged log nothing may be drawn, shown or read with another number: a verb exits 3, or
prints what it prints of the whole one. What `recover` saves has the numbers of the whole log.
pytest runs a config itself: there a log is damaged when it is closed, before it is judged, and each
item passes with the number of the whole log, or fails and names the damaged one.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))

from damaged_runs import DRAWN, Done, logs, made, verb
from judged_by_pytest import Judged, judged_by_pytest

from lavendersim.errors import TraceError
from lavendersim.trace import open_trace
from lavendersim.trace.index import read_summary

FLIGHT = """\
question: What is left of its energy?
scene:
  bodies:
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, position: [0, 0, 1]}
numerics: chapter
duration: 4
sweep:
  m: {path: scene.bodies.ball.mass, values: [1.0, 2.0]}
figure:
  caption: It falls.
  panels:
    - {kind: time_series, column: energy, title: energy, x_label: "t [s]", y_label: "E [J]"}
"""
FALL = DRAWN.replace("scene:\n", "scene:\n  gravity: [0, 0, -9.81]\n", 1)
FALL = FALL.replace("scene.bodies.ball.surface.restitution", "scene.gravity.2")
NONE = ("energy", "residual", "penetration", "impulses", "momentum")
SUMS = f"always: {{{', '.join(f'{name}: none' for name in NONE)}}}\n"
UNMEASURED = DRAWN[: DRAWN.index("measure:\n")] + DRAWN[DRAWN.index("figure:\n") :]
KINDS = {
    "contacts": DRAWN,
    "residuals": DRAWN + "record: {residuals: all}\n",
    "in flight": FLIGHT,
    "partly recorded": UNMEASURED + SUMS + "record: {contacts: every 4, poses: {from: 1, to: 3}}\n",
    "diverged": FALL.replace("[0.5, 0.52]", "[-9.81, 1e155]"),
}
TABLES = ("step", "recorded_contact", "residual")
ALLOWED_EVERY = 25  # of so many damaged logs one is drawn with --allow-incomplete, which takes time
READERS = ("verbs", "pytest")


class Damage(NamedTuple):
    """A damaged log: which, its bytes, and whether all of them are of one run."""

    what: str
    log: Path
    data: bytes
    of_one_log: bool = True


def damages(run: Path, flips: int, cuts: int, exchanges: int, seed: int) -> Iterator[Damage]:
    """Yield damaged logs of a run of two cells; of bits a third each: anywhere, head, end."""
    random = np.random.default_rng(seed)
    whole = {log: log.read_bytes() for log in logs(run)}
    places = list(whole)
    for number in range(flips):
        log = places[number % len(places)]
        data = bytearray(whole[log])
        edge = min(len(data), 8000)
        low, high = [(0, len(data)), (0, edge), (len(data) - edge, len(data))][number % 3]
        data[int(random.integers(low, high))] ^= 1 << int(random.integers(8))
        yield Damage("flip", log, bytes(data))
    for number in range(cuts):
        log = places[number % len(places)]
        yield Damage("cut", log, whole[log][: int(random.integers(len(whole[log])))])
    chunks = {log: read_summary(log).chunks for log in places}
    for number in range(exchanges):
        log = max(places, key=lambda one: len(chunks[one]))
        other = log if number % 2 else next(one for one in places if one != log)
        one, two = (chunks[of][int(random.integers(len(chunks[of])))] for of in (log, other))
        first, second = (
            slice(e.chunk_start_offset, e.chunk_start_offset + e.chunk_length) for e in (one, two)
        )
        data = bytearray(whole[log])
        if other == log and first.start > second.start:
            first, second = second, first
        moved = whole[log][first]
        if other == log and first != second:
            data[second] = moved
        data[first] = whole[other][second]
        yield Damage("exchange", log, bytes(data), other == log)


class Truth(NamedTuple):
    """What the verbs print of the whole run, and the numbers of its logs."""

    shown: Done
    listed: Done
    figures: dict[str, bytes]
    tables: dict[Path, dict[str, Any]]


def tables_of(log: Path, allow_incomplete: bool = False) -> dict[str, Any]:
    """Return every table of a log."""
    trace = open_trace(log, allow_incomplete)
    found = {name: getattr(trace, name) for name in TABLES}
    found["steps of poses"] = trace.step["step"][trace.recorded_pose.rows]
    found["pose"] = trace.recorded_pose.pose
    return found


def truth_of(run: Path) -> Truth:
    """Return what there is of a whole run."""
    figures = {path.name: path.read_bytes() for path in (run / "figures").iterdir()}
    listed = verb("ls", "--runs", run.parent)
    return Truth(verb("show", run), listed, figures, {log: tables_of(log) for log in logs(run)})


def same(one: Any, other: Any) -> bool:
    """Whether two tables are equal to the bit."""
    return one.dtype == other.dtype and one.tobytes() == other.tobytes()


def is_part(found: dict[str, Any], whole: dict[str, Any]) -> bool:
    """Whether tables have of some steps all that the whole ones have of these."""
    steps = found["step"]["step"]
    equal = same(found["step"], whole["step"][np.isin(whole["step"]["step"], steps)])
    for name in ("recorded_contact", "residual"):
        rows = whole[name]
        if rows.dtype.names:
            equal = equal and same(found[name], rows[np.isin(rows["step"], steps)])
    posed = np.isin(whole["steps of poses"], steps)
    return equal and same(found["pose"], whole["pose"][posed])


def check(run: Path, damage: Damage, truth: Truth, out: Path, allowed: bool) -> list[str]:
    """Put one damaged log to every verb; returns what each made of it."""
    if damage.data == damage.log.read_bytes():
        return ["unchanged"]
    whole = damage.log.read_bytes()
    cell = _of_cells(run).index(damage.log)
    try:
        damage.log.write_bytes(damage.data)
        for arguments in (("plot", run), ("replay", run, "--cell", cell, "--save", out / "a.rrd")):
            done = verb(*arguments)
            assert (done.code, done.stdout) == (3, ""), (arguments, done)
            assert str(damage.log) in done.stderr
            assert "Traceback" not in done.stderr
        figures = {path.name: path.read_bytes() for path in (run / "figures").iterdir()}
        assert figures == truth.figures
        assert not (out / "a.rrd").exists()
        found = ["plot, replay: 3"]
        for name, healthy, arguments in (
            ("show", truth.shown, ("show", run)),
            ("ls", truth.listed, ("ls", "--runs", run.parent)),
        ):
            done = verb(*arguments)
            assert done.code == 3 or done == healthy, (arguments, done)
            found.append(f"{name}: {done.code}")
        try:
            tables_of(damage.log)
            raise AssertionError("the Python interface read a damaged log")
        except TraceError:
            pass
        found.append(_recovered(damage, truth, out, whole))
        if allowed:
            done = verb("plot", run, "--allow-incomplete", "-o", out / "figures")
            assert done.code == 3, done
            assert str(damage.log) in done.stderr
    finally:
        damage.log.write_bytes(whole)
    return found


def _of_cells(run: Path) -> list[Path]:
    from lavendersim import open_run

    return [cell.path for cell in open_run(run).cells]


def _recovered(damage: Damage, truth: Truth, out: Path, whole: bytes) -> str:
    """Recover the log; what is saved has its numbers."""
    saved = out / "saved.mcap"
    saved.unlink(missing_ok=True)
    done = verb("recover", damage.log, "--output", saved)
    assert "Traceback" not in done.stderr, done
    assert damage.log.read_bytes() == damage.data
    assert done.code in (0, 3, 5), done
    assert saved.exists() == (done.code != 5)
    if done.code == 0:
        assert saved.read_bytes() == whole
    elif done.code == 3:
        assert done.stderr
        try:
            found = tables_of(saved, allow_incomplete=True)
        except TraceError as error:  # of which steps there is what, the config says
            assert "lost its attachment resolved.json" in str(error)  # noqa: PT017
        else:
            assert is_part(found, truth.tables[damage.log]) or not damage.of_one_log, done
    return f"recover: {('whole', '', '', 'part', '', 'nothing')[done.code]}"


def check_judged(run: Path, damage: Damage, out: Path, healthy: Judged, read: bool) -> list[str]:
    """Judge by pytest with one log damaged; a number is that of the whole log, or none and fails.

    read: the logs are judged from their files.
    """
    name, config = damage.log.name, run.parents[1] / "drop.yaml"
    if damage.data == healthy.logs[name]:
        return []
    found = judged_by_pytest(config, out / "pytest", {name: damage.data}, read)
    assert found.logs == healthy.logs
    assert found.items.keys() == healthy.items.keys()
    changed = [one for node, one in found.items.items() if one != healthy.items[node]]
    for outcome, text in changed:
        assert outcome == "failed"
        assert name in text
        assert "Traceback" not in text
    for node, number in found.numbers.items():
        if number != healthy.numbers[node]:
            assert (number, found.items[node] in changed) == ("nan", True), (node, number)
    if changed or damage.what == "cut":
        assert found.code == 1
        assert changed
    return [f"pytest: {1 if changed else 'same'}" + ("" if read else " in memory")]


def counted(
    kind: str,
    folder: Path,
    flips: int,
    cuts: int,
    exchanges: int,
    seed: int = 0,
    readers: Sequence[str] = READERS,
) -> dict[str, Counter[str]]:
    """Return, by what was done to a log, how many readers made what of it."""
    folder.mkdir()
    run, out = made(KINDS[kind], folder), folder / "out"
    out.mkdir()
    truth = truth_of(run)
    healthy = judged_by_pytest(folder / "drop.yaml", out / "pytest", {})
    assert healthy.logs == {log.name: log.read_bytes() for log in logs(run)}
    counts: dict[str, Counter[str]] = {}
    for number, damage in enumerate(damages(run, flips, cuts, exchanges, seed)):
        seldom = number % ALLOWED_EVERY == 0
        found = check(run, damage, truth, out, seldom) if "verbs" in readers else []
        if "pytest" in readers:
            found += check_judged(run, damage, out, healthy, read=not seldom)
        counts.setdefault(damage.what, Counter()).update(found)
    return counts


def main() -> None:
    """Damage logs of every kind and print what became of them."""
    parser = argparse.ArgumentParser(description=__doc__)
    for name, count in (("--flips", 1000), ("--cuts", 200), ("--exchanges", 50), ("--seed", 0)):
        parser.add_argument(name, type=int, default=count)
    parser.add_argument("--kinds", nargs="+", choices=list(KINDS), default=list(KINDS))
    parser.add_argument("--readers", nargs="+", choices=READERS, default=READERS)
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        for kind in asked.kinds:
            how = asked.flips, asked.cuts, asked.exchanges, asked.seed, asked.readers
            counts = counted(kind, Path(folder) / kind, *how)
            for what, found in counts.items():
                print(
                    f"{kind:16} {what:9}",
                    ", ".join(f"{k} {n}" for k, n in sorted(found.items())),
                    flush=True,
                )


if __name__ == "__main__":
    main()
