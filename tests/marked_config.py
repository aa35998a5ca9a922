"""Small configs whose defects are marked: `§` stands where a sentence must point, and is removed.

    assert_refused(config(duration="§0"), "duration: expected a number above 0 s, found 0")

The place that is expected is so counted in the text itself, and in no message.
"""

from __future__ import annotations

from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment_text

MARK = "§"
FLOOR = "floor: {shape: {kind: plane}}"
BALL = "ball: {shape: {kind: sphere, radius: 0.1}, mass: 1, position: [0, 0, 1]}"


def scene(*bodies: str, **sections: str) -> str:
    """Return a scene on one line, a floor and a ball where no bodies are given."""
    given = ", ".join(bodies or (FLOOR, BALL))
    rest = "".join(f", {key}: {value}" for key, value in sections.items())
    return f"{{bodies: {{{given}}}{rest}}}"


def config(**sections: str) -> str:
    """Return a config of one line for each section; the scene of `scene` and 1 s by default."""
    whole = {"scene": scene(), "duration": "1", **sections}
    return "".join(f"{key}: {value}\n" for key, value in whole.items())


def marked_places(text: str) -> tuple[str, list[str]]:
    """Return the text without marks, and line and column of each, counted from 1."""
    places = []
    for number, line in enumerate(text.split("\n"), start=1):
        parts = line.split(MARK)
        columns = [len("".join(parts[:count])) + 1 for count in range(1, len(parts))]
        places += [f"{number}:{column}" for column in columns]
    return text.replace(MARK, ""), places


def refusals(text: str) -> list[str]:
    """Return `line:column: sentence` of every defect of a config; none where it is read."""
    try:
        load_experiment_text(text, "marked.yaml")
    except ConfigError as error:
        return [line.removeprefix("marked.yaml:") for line in str(error).splitlines()]
    return []


def assert_refused(marked: str, *sentences: str) -> None:
    """Assert that a config has these defects and no others, each at its mark."""
    text, places = marked_places(marked)
    expected = [f"{place}: {said}" for place, said in zip(places, sentences, strict=True)]
    assert refusals(text) == expected
