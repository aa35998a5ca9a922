"""What a syntax error of PyYAML means, and where: our sentences for its complaints.

libyaml and PyYAML word the same problem differently and point at where they noticed it, which is
often a line below the mistake: sentences and places are chosen here by the kind of problem.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

import yaml

from lavendersim.experiment.text.node import Mark

_TAB = re.compile(r"^ *\t[ \t]*(?=[^\s#])", re.MULTILINE)
MOST_TABS = 50
_LINE_BREAK = re.compile("\r\n|[\n\r\x85\u2028\u2029]")  # what YAML 1.1 parsers count as one

# (words in the problem, words in its context, sentence, points at the start of the construct)
_KINDS: tuple[tuple[str, str, str, bool], ...] = (
    ("mapping values are not allowed", "", 'a ":" too many; put text that contains ": " in quotes',
     False),
    ("unexpected end of stream", "quoted scalar", "a quote that is not closed", True),
    ("document indicator", "quoted scalar", "a quote that is not closed", True),
    ("", "flow sequence", 'a "[" that is not closed, or a "," that is missing after it', True),
    ("", "flow mapping", 'a "{" that is not closed, or a "," that is missing after it', True),
    ("", "block mapping", "expected a key of the mapping here; is the indentation right?", False),
    ("", "block collection", 'expected a "-" of the list here; is the indentation right?', False),
    ("block sequence entries are not allowed", "", 'a "-" where no list can start', False),
    ("expected ':'", "simple key", 'a line without ":"; expected "key: value"', True),
    ("cannot start any token", "", "this character cannot start a value; put it in quotes", False),
    ("escape", "quoted scalar", "an unknown escape; use single quotes for text with backslashes",
     False),
)  # fmt: skip


def describe(error: yaml.MarkedYAMLError, text: str) -> Iterator[tuple[Mark, str]]:
    """Yield the defects behind one syntax error; lines indented with tabs are all named."""
    if tabs := list(_TAB.finditer(text)):
        for tab in tabs[:MOST_TABS]:
            place = Mark(text.count("\n", 0, tab.start()) + 1, tab[0].index("\t") + 1)
            yield place, "indented with a tab; YAML is indented with spaces"
        return
    problem, context = error.problem or "", error.context or ""
    for words, context_words, sentence, at_start in _KINDS:
        if words in problem and context_words in context:
            mark = error.context_mark if at_start else error.problem_mark
            yield _defect(text, mark or error.problem_mark, sentence)
            return
    yield _defect(text, error.problem_mark, f"not YAML: {problem or context}")


def _defect(text: str, mark: object, sentence: str) -> tuple[Mark, str]:
    """Return the defect, moved to the end of the text where the parsers point behind it."""
    lines = _LINE_BREAK.split(text)
    line, column = getattr(mark, "line", 0), getattr(mark, "column", 0)
    if line >= len(lines):
        line, column = len(lines) - 1, len(lines[-1])
        sentence = "the text ends too early; is a bracket or a quote not closed?"
    return Mark(line + 1, min(column, len(lines[line])) + 1), sentence
