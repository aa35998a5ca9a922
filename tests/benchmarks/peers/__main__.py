"""Engines beside each other on the same scenes: a table, Markdown and JSON with every sample.

    pip install -e ".[peers]"
    python -m tests.benchmarks.peers [--engines lavender mujoco bullet-rigid ...]
        [--scenes stack_6 tower_30 ...] [--repeats 5] [--output F.json] [--markdown F.md]

An engine stands for all its variants, `engine-default` for the one with its own settings. An
engine that is not installed, and a scene that an engine cannot do, are said in one line.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import sys
from pathlib import Path
from typing import Any

from .adapter import ADAPTERS, variants_of
from .measure import measure
from .studies import STUDIES, tiny
from .table import as_markdown, as_text

TINY = "tiny"


def processor() -> str:
    """Return the processor's name where the system tells it."""
    info = Path("/proc/cpuinfo")
    lines = info.read_text().splitlines() if info.exists() else []
    named = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return named[0] if named else platform.processor()


def arguments() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(description="The same scenes on several engines.")
    parser.add_argument("--engines", nargs="+", default=list(ADAPTERS), metavar="ENGINE")
    parser.add_argument(
        "--scenes", nargs="+", default=list(STUDIES), choices=[*STUDIES, TINY], metavar="SCENE"
    )
    parser.add_argument("--repeats", type=int, default=5, help="timed runs of every scene")
    parser.add_argument(
        "--limit", type=float, default=300.0, help="seconds per engine and scene and pass"
    )
    parser.add_argument("--output", type=Path, help="JSON file with every sample")
    parser.add_argument("--markdown", type=Path, help="file for the table in Markdown")
    parser.add_argument("--quiet", action="store_true", help="no progress on stderr")
    return parser.parse_args()


def main() -> int:
    """Measure, print, write; 2 where no engine runs."""
    asked = arguments()
    engines, missing = variants_of(asked.engines)
    for name, why in missing.items():
        print(f"{name} does not run here: {why}", file=sys.stderr)
    if not engines:
        return 2
    studies = {name: tiny() if name == TINY else STUDIES[name] for name in asked.scenes}

    def tell(text: str) -> None:
        if not asked.quiet:
            print(text, file=sys.stderr, flush=True)

    found: dict[str, Any] = {
        "repeats": asked.repeats,
        "machine": {"processor": processor(), "cores": os.cpu_count()},
        "engines": [
            {"variant": each.variant, "version": each.version, "settings": each.settings}
            for each in engines
        ],
        "missing": missing,
        "scenes": measure(engines, studies, asked.repeats, asked.limit, tell),
    }
    print(as_text(found))
    if asked.output:
        asked.output.write_text(json.dumps(found) + "\n")
    if asked.markdown:
        asked.markdown.write_text(as_markdown(found) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
