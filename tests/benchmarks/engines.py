"""The tables of other engines in README.md and docs/results.md, with the raw samples behind them.

    python -m tests.benchmarks.engines [--runs DIR]   runs COMMANDS, keeps samples, writes tables
    python -m tests.benchmarks.engines --tables       writes the tables from what is kept
    python -m tests.benchmarks.engines --large        runs LARGE, keeps it beside them, likewise
    python -m tests.benchmarks.engines --compare [CASE ...]   makes logs again: which differ?

Every number is of `lavender check` or `lavender cost` with `--engine all`, of one commit on one
machine. Kept in docs/engines are every entry of the matrix (check.json), every setting with every
sample of its time (cost.json), and commands, commit, versions, bytes and SHA-256 of every log
(logs.json). Logs themselves are too large for a repository. The same versions make the same bytes
on a machine like it: `--compare` makes them again, of all commands or of some cases of the matrix,
and says of each whether it is the same. A log has its config as its commit writes it, and cells are
named by that: they are made by the sources of the commit that the kept ones are of.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import subprocess
import sys
import tarfile
from collections.abc import Sequence
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from lavendersim.measures.cost_table import CostRow, CostTable
from lavendersim.peers.catalogue import PEERS, installed_version
from lavendersim.quantities.short_times import short_time
from lavendersim.runner.cost_targets import error_of, name_of, percent
from lavendersim.runner.environment import processor, versions

ROOT = Path(__file__).resolve().parents[2]
KEPT = ROOT / "docs" / "engines"
SOURCES = (".", ":!docs/engines")  # what is kept is written before it is asked for
PAGES = (ROOT / "README.md", ROOT / "docs" / "results.md")
SCENES = ("rest", "stack_of_six", "heavy_on_light")
TRACKERS = ("launched_box", "pressed_against_a_wall")
COMMANDS = {
    "check": [
        *("lavender", "check"),
        *(f"configs/scenes/{name}.yaml" for name in SCENES),
        *(f"configs/trackers/{name}.yaml" for name in TRACKERS),
        *("--engine", "all", "--yes", "--json"),
    ],
    "cost": [
        *("lavender", "cost", "configs/cost/stack_by_engines.yaml"),
        *("--engine", "all", "--target", "0.1%", "--no-plot", "--yes", "--json"),
    ],
}
LARGE = [  # started once: a step of DART's takes a third of a second and more
    *("lavender", "check", "configs/cost/pyramid.yaml", "configs/cost/pile.yaml"),
    *("--engine", "all", "--starts", "1", "--yes", "--json"),
]
Digests = dict[str, dict[str, str]]
# Where somebody's run and kernels lay.
PLACES = ("run", "log", "figures", "detail", "kernel cache")


def take(runs: Path) -> None:
    """Run every command and keep what it says."""
    KEPT.mkdir(exist_ok=True)
    for name, words in COMMANDS.items():
        done = subprocess.run(
            [*words, "--runs", str(runs)], cwd=ROOT, stdout=subprocess.PIPE, text=True
        )
        if done.returncode > 1:  # 1: an engine fails a case, or no engine reaches the target
            sys.exit(f"{' '.join(words)}: exit code {done.returncode}")
        _write(f"{name}.json", without_places(json.loads(done.stdout)))
    commands = {name: " ".join(words) for name, words in COMMANDS.items()}
    _write("logs.json", {"commands": commands, **made(runs)})


def take_large(runs: Path) -> None:
    """Run LARGE and keep what it says, with what it was made by."""
    done = subprocess.run(
        [*LARGE, "--runs", str(runs)], cwd=ROOT, stdout=subprocess.PIPE, text=True
    )
    if done.returncode > 1:
        sys.exit(f"{' '.join(LARGE)}: exit code {done.returncode}")
    keep_large(json.loads(done.stdout), made(runs))


def compare(cases: Sequence[str], place: Path) -> list[str]:
    """Make logs again, of some cases or of all commands; returns what is other than is kept.

    place: where sources and runs are left.
    """
    kept = json.loads((KEPT / "logs.json").read_text())
    sources, runs = place / "sources", place / "runs"
    put_sources(kept["commit"], sources)
    commands = [words for name, words in kept["commands"].items() if name == "check" or not cases]
    for words in commands:
        lavender, *left = [one for one in words.split() if not cases or is_asked(one, cases)]
        assert lavender == "lavender"
        subprocess.run(
            [sys.executable, "-m", "lavender_cli.main", *left, "--runs", str(runs)],
            cwd=sources,
            env=os.environ | {"PYTHONPATH": str(sources)},
            stdout=subprocess.DEVNULL,
        )
    now = made(runs)
    differ = [
        f"{name}: {now[name]}, the kept logs are of {kept[name]}"
        for name in ("processor", "versions")
        if now[name] != kept[name]
    ]
    return differ + unequal_logs(kept["sha256"], now["sha256"])


def put_sources(commit: str, folder: Path) -> None:
    """Put the sources of a commit into a folder, so that Python finds them there."""
    packed = subprocess.run(["git", "archive", commit], cwd=ROOT, capture_output=True)
    if packed.returncode:
        sys.exit(f"commit {commit}, of which logs are kept, is not in this clone")
    with tarfile.open(fileobj=BytesIO(packed.stdout)) as archive:
        archive.extractall(folder, filter="data")
    (folder / "lavender_cli").symlink_to("cli")


def is_asked(word: str, cases: Sequence[str]) -> bool:
    """Return whether a word of a command is no config, or one of these cases."""
    return not word.endswith(".yaml") or Path(word).stem in cases


def unequal_logs(kept: Digests, found: Digests) -> list[str]:
    """Return a sentence for each experiment of which a log is another one, or is not kept."""
    sentences = []
    for name, own in found.items():
        before = kept.get(name, {})
        other = [log for log, digest in own.items() if before.get(log) != digest]
        if other:
            sentences.append(f"{name}: {len(other)} of {len(own)} logs differ: {', '.join(other)}")
    return sentences or ([] if found else ["no log was made"])


def keep_large(check: Any, by: dict[str, Any]) -> None:
    """Keep the matrix of LARGE."""
    _write("large.json", {"command": " ".join(LARGE), **by, "check": without_places(check)})


def made(runs: Path) -> dict[str, Any]:
    """Return by what logs were made: commit, machine, versions; and their SHA-256."""
    engines = {
        peer.package: installed_version(name)
        for name, peer in PEERS.items()
        if installed_version(name)
    }
    return {
        "commit": _git("rev-parse", "HEAD"),
        "changed": bool(_git("status", "--porcelain", "--untracked-files=no", "--", *SOURCES)),
        "processor": processor(),
        "versions": versions() | engines,
        "bytes": sum(log.stat().st_size for log in logs_of(runs)),
        "sha256": digests(runs),
    }


def _git(*words: str) -> str:
    return subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True).stdout.strip()


def _write(name: str, data: Any) -> None:
    (KEPT / name).write_text(json.dumps(data, indent=1) + "\n")


def without_places(data: Any) -> Any:
    """Return what a command said without the paths of its run."""
    if isinstance(data, dict):
        return {key: without_places(one) for key, one in data.items() if key not in PLACES}
    return [without_places(one) for one in data] if isinstance(data, list) else data


def logs_of(runs: Path) -> list[Path]:
    """Return the logs of all runs; not those of `latest`, which is one of them."""
    return sorted(runs.glob("*-*/cells/*.mcap"))


def digests(runs: Path) -> Digests:
    """Return by experiment the SHA-256 of each log, by the cell that it is of."""
    found: Digests = {}
    for log in logs_of(runs):
        # 20261126T055000Z-rest-...: the name begins with its time
        own = found.setdefault(log.parent.parent.name.partition("-")[2], {})
        own[log.stem] = hashlib.sha256(log.read_bytes()).hexdigest()
    return found


def tables() -> str:
    """Return the tables, and what they are of."""
    check, (cost,), made = (
        json.loads((KEPT / f"{name}.json").read_text()) for name in ("check", "cost", "logs")
    )
    table = CostTable.of({key: one for key, one in cost.items() if key not in PLACES})
    versions_ = made["versions"]
    engines = ", ".join(
        f"{peer.title} ({peer.package} {versions_[peer.package]})"
        for peer in PEERS.values()
        if peer.package in versions_
    )
    commit = made["commit"][:8] + (" and changes" if made["changed"] else "")
    return "\n".join(
        [
            "```sh",
            *made["commands"].values(),
            "```",
            "",
            *cost_lines(table),
            "",
            *check_lines(check),
            "",
            f"Commit {commit}, {made['processor']}; {engines}. Times are medians of "
            f"{table.repeats} interleaved rounds, other work was on the machine. Errors are ranges "
            "over three starts, the worst counts. A square has the number of the first claim that "
            "failed, or of the one nearest its bound, and the range of the worst cell of each "
            "start; check.json names the claims. Every sample, and the SHA-256 of every log, is "
            "kept in `docs/engines`; `python -m tests.benchmarks.engines` makes all of it anew.",
            *large_lines(),
        ]
    )


def large_lines() -> list[str]:
    """Return the table of LARGE; nothing where it is not kept."""
    if not (KEPT / "large.json").exists():
        return []
    kept = json.loads((KEPT / "large.json").read_text())
    return [
        "",
        "A pyramid of 55 boxes and a pile of 200 spheres, started once:",
        "",
        "```sh",
        kept["command"],
        "```",
        "",
        *check_lines(kept["check"]),
        "",
        f"Commit {kept['commit'][:8]}; the rest as above. `large.json` has all logs' SHA-256.",
    ]


def cost_lines(table: CostTable) -> list[str]:
    """Return an engine a row: at its own defaults, and the cheapest setting at the first target."""
    answers = {one.engine: one for one in table.targets}
    lines = [
        "| stack of six, 2 s | own defaults: error | a simulated second | contacts, iterations "
        f"a step | cheapest at {percent(table.targets[0].target)} | a simulated second |",
        "|---|---:|---:|---|---|---:|",
    ]
    for engine in table.engines:
        rows = [row for row in table.rows if row.family == engine]
        own = next(row for row in rows if row.is_own)
        answer = answers[engine]
        reached = table.rows[answer.row] if answer.row is not None else None
        best = min((row for row in rows if row.is_answer), key=error_of, default=None)
        missed = (
            "every setting failed" if best is None else f"none; at best {percent(error_of(best))}"
        )
        lines.append(
            f"| {own.title} | {spread_of(own)} | {time_of(own)} | {counts_of(own)} | "
            f"{missed if reached is None else name_of(reached)} | "
            f"{'' if reached is None else time_of(reached)} |"
        )
    return lines


def spread_of(row: CostRow) -> str:
    """Return the errors of a setting over its starts; or that it failed."""
    if row.failed or row.error is None:
        return "failed" + ("" if row.error is None else f", {percent(row.error)}")
    least = "" if row.least_error is None else f"{percent(row.least_error)} to "
    return f"{least}{percent(row.error)}"


def time_of(row: CostRow) -> str:
    """Return the cost of a setting."""
    return "" if row.ns_per_second is None else short_time(row.cost / 1e9)


def counts_of(row: CostRow) -> str:
    """Return the contacts and iterations of a step."""
    return ", ".join(
        "not reported" if one is None else f"{one:.3g}" for one in (row.contacts, row.iterations)
    )


def check_lines(check: dict[str, Any]) -> list[str]:
    """Return a case a row and an engine a column: verdict, number, its range over starts."""
    engines = list(check["solvers"])
    lines = [f"| case | {' | '.join(engines)} |", "|---|" + "---|" * len(engines)]
    found = {(one["case"], one["solver"]): one for one in check["entries"]}
    for case in check["cases"]:
        cells = [_entry(found[case, engine]) for engine in engines]
        lines.append(f"| {case.rpartition('/')[2]} | {' | '.join(cells)} |")
    return lines


def _entry(one: dict[str, Any]) -> str:
    if one["number"] is None:
        return str(one["verdict"])
    low, high = one["least"], one["most"]
    spread = f" ({low:.2g} to {high:.2g})" if low is not None and low != high else ""
    return f"{one['verdict']} {one['number']:.2g}{spread}"


def write_tables() -> None:
    """Write the tables where pages have room for them."""
    text = tables()
    for page in PAGES:
        part = "\n".join(cost_only(text)) if page.name == "README.md" else text
        page.write_text(with_part(page.read_text(), part))


def with_part(page: str, part: str) -> str:
    """Return a page with a part between its marks."""
    before, begin, rest = page.partition("<!-- engines -->\n")
    _, end, after = rest.partition("<!-- end -->")
    if not begin or not end:
        sys.exit("a page has no marks for the tables of engines")
    return f"{before}{begin}\n{part}\n\n{end}{after}"


def cost_only(text: str) -> list[str]:
    """Return the first table of a text."""
    lines = [line for line in text.splitlines() if line.startswith("|")]
    return lines[
        : next((k for k, line in enumerate(lines) if line.startswith("| case")), len(lines))
    ]


def main(arguments: Sequence[str] | None = None) -> None:
    """Take the samples, unless they are there, and write the tables."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--runs", type=Path, default=ROOT / "runs" / "engines")
    parser.add_argument("--tables", action="store_true")
    parser.add_argument("--large", action="store_true")
    parser.add_argument("--compare", nargs="*", metavar="CASE")
    given = parser.parse_args(arguments)
    if given.compare is not None:
        with TemporaryDirectory() as place:
            differ = compare(given.compare, Path(place))
        sys.exit("\n".join(differ) if differ else 0)
    if given.large:
        take_large(given.runs.resolve())
    elif not given.tables:
        take(given.runs.resolve())
    write_tables()


if __name__ == "__main__":
    main()
