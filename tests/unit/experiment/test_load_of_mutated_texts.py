"""A good config with tokens lost, doubled or replaced is an Experiment or refused with reasons.

Whatever a text is, the loader neither crashes nor points outside of it.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from lavendersim.errors import ConfigError
from lavendersim.experiment import Experiment, load_experiment_text
from tests.many_keys_config import MANY_KEYS

CONFIGS = Path(__file__).parents[3] / "configs"
SHIPPED = [path.read_text(encoding="utf-8") for path in sorted(CONFIGS.glob("*/*.yaml"))]
GOOD = [text for text in SHIPPED if "\nextends:" not in text]  # a text has no folder to look in
WALL = "    wall: {shape: {kind: box, size: [1, 1, 1]}, fixed: true, position: [-5, 0, 0]}\n"
# What is no number: a fixed body, words, a sweep and a claim of some of its cells.
EVERYTHING = (
    MANY_KEYS.replace("  arrangements:\n", WALL + "  arrangements:\n").replace(
        "measure: aside, equals", "measure: aside, at: {e: 0.5}, equals"
    )
    + """\
expected: Nothing breaks.
sweep:
  e: {path: scene.surfaces.rubber.restitution, values: [0, 0.5]}
  phase: {path: scene.bodies.ball.release.phase, values: [0, 1/16]}
  count: {path: scene.arrangements.tower.count, values: [2, 3]}
"""
)
TOKEN = re.compile(r"[A-Za-z_]\w*|[-+]?\d[\d./e+-]*|\n *|\s+|.")
STRANGE = [
    *"[]{}:,-?&*!|>'\"%@`#~\t\n\x85\u2028\ufeff\x00é😀",
    *("null", "true", "yes", ".nan", "-1", "1e400", "1/0", "0", "''", "- ", ": ", "\n  ", "\n"),
    *("ball", "floor", "kind", "plane", "box", "scene", "numerics", "path", "values", "9" * 70),
    *("scene.bodies", "events.0", "events.9", "numerics.timestep", "5 ms", "!!python/none", "*a"),
    *("hull", "compound", "parts", "points", "tower", "count", "tower_3", "arrangements", "slope"),
    *("<<", "...", "---", "{}", "[]", "[[0, 1], {a: b}]", "at", "any", "index", "1e-9", "1e9"),
]
LINE_BREAK = re.compile("\r\n|[\n\r\x85\u2028\u2029]")  # of YAML 1.1, as libyaml counts

mutation = st.tuples(
    st.integers(0, 10**6), st.sampled_from(["drop", "double", "replace", "swap", "cut"]),
    st.sampled_from(STRANGE),
)  # fmt: skip


def mutated(text: str, mutations: list[tuple[int, str, str]]) -> str:
    tokens = TOKEN.findall(text)
    for number, kind, strange in mutations:
        if not tokens:
            return strange
        at = number % len(tokens)
        if kind == "drop":
            del tokens[at]
        elif kind == "double":
            tokens.insert(at, tokens[at])
        elif kind == "replace":
            tokens[at] = strange
        elif kind == "swap":
            other = (number // 7) % len(tokens)
            tokens[at], tokens[other] = tokens[other], tokens[at]
        else:
            del tokens[at + 50 :]
    return "".join(tokens)


def load_or_refuse(text: str) -> Experiment | ConfigError:
    try:
        return load_experiment_text(text, "mutated.yaml")
    except ConfigError as refusal:
        return refusal


def check(text: str) -> None:
    lines = LINE_BREAK.split(text.removeprefix("\ufeff"))
    read = load_or_refuse(text)
    if isinstance(read, Experiment):
        assert all(len(cell.digest) == 64 for cell in read.cells()[:3])
        return
    places = [(defect.line, defect.column) for defect in read.defects]
    assert places
    assert places == sorted(places)
    assert len(set(read.defects)) == len(read.defects)
    for defect in read.defects:
        assert 1 <= defect.line <= len(lines)
        assert 1 <= defect.column <= len(lines[defect.line - 1]) + 1
        assert "\n" not in defect.message


@pytest.mark.parametrize("text", [EVERYTHING, *GOOD])
def test_unchanged_config_loads(text: str) -> None:
    assert load_experiment_text(text, "good.yaml").cells()


@settings(max_examples=400, deadline=None)
@given(text=st.sampled_from([EVERYTHING, *GOOD]), mutations=st.lists(mutation, max_size=6))
def test_mutated_config_is_read_or_refused(
    text: str, mutations: list[tuple[int, str, str]]
) -> None:
    check(mutated(text, mutations))


@settings(max_examples=200, deadline=None)
@given(text=st.text(st.sampled_from("abk:,-[]{}?!&*'\"|>%@# \n\t019./\x85é"), max_size=60))
@example(text="? [a]\n: b")
@example(text="a: |\n")
@example(text="\ufeff")
def test_any_text_is_refused_within_itself(text: str) -> None:
    check(text)
