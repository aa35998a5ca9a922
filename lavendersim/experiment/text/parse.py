"""From the bytes of a file to a tree of nodes, and the defects of its form.

The tree is composed here from PyYAML's event stream: its own composers recurse (the C one crashes
on 100,000 nested brackets), resolve YAML 1.1 scalars, and let a key stand twice. There are no
tags, anchors or aliases in a config, so nothing is constructed and nothing can grow.
"""

from __future__ import annotations

import codecs
import re
from collections.abc import Iterator
from itertools import islice
from typing import Any

import yaml

from lavendersim.experiment.text.node import BROKEN, Mark, Node
from lavendersim.experiment.text.report import Report
from lavendersim.experiment.text.syntax import describe
from lavendersim.garbage import uncollected
from lavendersim.quantities.found import quoted
from lavendersim.quantities.scalars import ScalarError, resolve

LARGEST_FILE = 1 << 20  # [byte]
DEEPEST = 32  # a config needs about six levels
MOST_VALUES = 100_000
_DEEPEST_OF_LIBYAML = "exceeded maximum nesting depth"  # 1000 levels, from libyaml 0.2.6 on

_UNPRINTABLE = re.compile(
    "[^\t\n\r\x20-\x7e\x85\xa0-\u2027\u202a-\ud7ff\ue000-\ufefe\uff00-\ufffd\U00010000-\U0010ffff]"
)
_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


class _Stop(Exception):  # noqa: N818 - ends the reading; the defect is already noted
    pass


class _Open:
    """A list or mapping whose end has not been read."""

    def __init__(self, mark: Mark, is_mapping: bool) -> None:
        self.mark = mark
        self.is_mapping = is_mapping
        self.items: list[Node] = []
        self.entries: dict[str, Node] = {}
        self.keys: dict[str, Mark] = {}
        self.key: str | None = None  # read, and waiting for its value
        self.drops_value = False  # the key was refused
        self.incomplete = False


def parse(raw: bytes, report: Report, size: int | None = None, file: str = "") -> Node | None:
    """Return the tree, None where there is none to speak of; notes what is wrong with the text.

    `size` is the length of the file [byte] when `raw` is only its beginning; `file` its name where
    it is not the one that the report is about.
    """
    composer = _Composer(report, file)
    try:
        with uncollected():  # the tree has no circles, and at most MOST_VALUES nodes
            return composer.compose(composer.decode(raw, size or len(raw)))
    except _Stop:
        return None
    finally:
        report.close_round()


def decode(raw: bytes) -> str:
    """Return the text of a file that `parse` found readable, without its byte order mark."""
    return raw.removeprefix(codecs.BOM_UTF8).decode("utf-8")


class _Composer:
    def __init__(self, report: Report, file: str) -> None:
        self.report = report
        self.file = file
        self.stack: list[_Open] = []
        self.root: Node | None = None
        self.anchors: set[str] = set()
        self.values = 0

    def stop(self, mark: Mark, message: str) -> _Stop:
        self.report.add(mark._replace(file=self.file), message)
        return _Stop()

    def decode(self, raw: bytes, size: int) -> str:
        if size > LARGEST_FILE:
            raise self.stop(Mark(1, 1), f"the file has {size} bytes; a config has at most 1 MiB")
        if raw[:2] in (b"\xff\xfe", b"\xfe\xff"):
            raise self.stop(Mark(1, 1), "the file is UTF-16; save it as UTF-8")
        try:
            text = decode(raw)
        except UnicodeDecodeError as error:
            refused: bytes = error.object  # without the byte order mark
            before = refused[: error.start].decode("utf-8")
            message = f"byte 0x{refused[error.start]:02x} is not UTF-8; save the file as UTF-8"
            raise self.stop(_mark_after(before), message) from None
        if match := _UNPRINTABLE.search(text):
            message = f"control character U+{ord(match[0]):04X}; remove it"
            raise self.stop(_mark_after(text[: match.start()]), message)
        return text

    def compose(self, text: str) -> Node | None:
        try:
            self._read(_events(text))
        except yaml.MarkedYAMLError as error:
            for mark, sentence in describe(error, text):
                self.report.add(mark._replace(file=self.file), sentence)
            return None
        if self.root is None or self.root.content is None:
            raise self.stop(Mark(1, 1), "the file is empty; an experiment has a scene, a duration")
        return self.root

    def _read(self, events: Iterator[Any]) -> None:
        documents = 0
        for event in events:
            start = event.start_mark
            mark = Mark(start.line + 1, start.column + 1, self.file)
            if isinstance(event, yaml.NodeEvent):
                self._node(event, mark)
            elif isinstance(event, yaml.DocumentStartEvent):
                documents += 1
                if documents > 1:
                    raise self.stop(mark, "a second document; a file holds one experiment")
            elif isinstance(event, yaml.CollectionEndEvent):
                done = self.stack.pop()
                content = done.entries if done.is_mapping else tuple(done.items)
                self._place(Node(content, done.mark, done.keys, done.incomplete), done.mark)

    def _node(self, event: Any, mark: Mark) -> None:
        self.values += 1
        if self.values > MOST_VALUES:
            raise self.stop(mark, f"more than {MOST_VALUES} values in one file")
        if event.__class__ is yaml.AliasEvent:
            if event.anchor not in self.anchors:
                self.report.add(mark, f"alias *{event.anchor}: there is no such anchor")
            self._place(Node(BROKEN, mark), mark)
            return
        refused = False
        if event.tag is not None or event.anchor is not None:
            refused = self._refuse_properties(event, mark)
        if event.__class__ is yaml.ScalarEvent:
            # as an escape such as "\\x1b"; most texts are plain, which is seen at once
            plain = event.value.isascii() and event.value.isprintable()
            if not plain and (match := _UNPRINTABLE.search(event.value)):
                self.report.add(mark, f"control character U+{ord(match[0]):04X}; remove it")
            self._place(self._scalar(event, mark, refused), mark, event.value)
            return
        if len(self.stack) >= DEEPEST:
            raise self.stop(mark, f"nested deeper than {DEEPEST} levels")
        self.stack.append(_Open(mark, isinstance(event, yaml.MappingStartEvent)))

    def _refuse_properties(self, event: Any, mark: Mark) -> bool:
        if event.tag is not None:
            tag = event.tag.replace("tag:yaml.org,2002:", "!!")
            self.report.add(mark, f"tag {quoted(tag)}: a config has no tags, only plain values")
        if event.anchor is not None:
            message = f"anchor &{event.anchor}: anchors and aliases are not read"
            self.report.add(mark, f"{message}; write the value out where it is used")
            self.anchors.add(event.anchor)
        return event.tag is not None

    def _scalar(self, event: Any, mark: Mark, refused: bool) -> Node:
        if refused:
            return Node(BROKEN, mark)
        if not event.implicit[0]:  # quoted, or a block of text
            return Node(event.value, mark)
        if self.stack and self.stack[-1].is_mapping and self.stack[-1].key is None:
            return Node(event.value, mark)  # keys are text, whatever they look like
        try:
            return Node(resolve(event.value), mark)
        except ScalarError as error:
            self.report.add(mark, str(error))
            return Node(BROKEN, mark)

    def _place(self, node: Node, mark: Mark, text: str | None = None) -> None:
        if not self.stack:
            self.root = node
            return
        into = self.stack[-1]
        if not into.is_mapping:
            into.items.append(node)
        elif into.key is not None:
            if not into.drops_value:
                into.entries[into.key] = node
            into.key = None
        else:
            self._key(into, mark, text)

    def _key(self, into: _Open, mark: Mark, text: str | None) -> None:
        into.drops_value = False
        if text is None:
            self.report.add(mark, "a key is a list, a mapping or an alias; a key is a name")
            into.drops_value = into.incomplete = True
        elif text in into.keys:
            first = into.keys[text].line
            self.report.add(mark, f"key {quoted(text)} stands twice, first in line {first}")
            into.drops_value = True
        else:
            into.keys[text] = mark
        into.key = text or ""


def _events(text: str) -> Iterator[Any]:
    """Yield the events of a text, of what is nested too deep for libyaml those before that.

    libyaml scans the rest of a line for a key, so it may complain before the level beyond DEEPEST.
    """
    count = 0
    try:
        for event in yaml.parse(text, _LOADER):
            count += 1
            yield event
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark
        if error.problem != _DEEPEST_OF_LIBYAML or mark is None:
            raise
        yield from islice(yaml.parse(text[: mark.index], _LOADER), count, None)


def _mark_after(text: str) -> Mark:
    lines = text.split("\n")
    return Mark(len(lines), len(lines[-1]) + 1)
