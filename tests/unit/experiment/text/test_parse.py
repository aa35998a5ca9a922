"""From bytes to a tree: places as PyYAML's composer has them, and every defect of the form."""

from __future__ import annotations

import gc

import pytest
import yaml

from lavendersim.experiment.text.node import BROKEN, Node
from lavendersim.experiment.text.parse import DEEPEST, MOST_VALUES, decode, parse
from lavendersim.experiment.text.report import Report
from tests.marked_config import marked_places

TEXT = """\
# a comment
scene:
  bodies: {ball: [1, "two", 'three'], "quoted key": ~}
  text: |
    of two
    lines
list:
- a
- b: -1.5e3
  é: [[], {}]
"""


def tree(text: str | bytes) -> tuple[Node | None, list[str]]:
    report = Report("f")
    raw = text.encode() if isinstance(text, str) else text
    root = parse(raw, report)
    return root, [str(defect).removeprefix("f:") for defect in report.defects]


def same(node: Node, other: yaml.Node) -> None:
    """Compare form, places and texts with those of PyYAML's composer."""
    assert (node.mark.line - 1, node.mark.column - 1) == (
        other.start_mark.line,
        other.start_mark.column,
    )
    if isinstance(other, yaml.MappingNode):
        assert list(node.entries) == [key.value for key, _ in other.value]
        for key, value in other.value:
            mark = node.keys[key.value]
            assert (mark.line - 1, mark.column - 1) == (key.start_mark.line, key.start_mark.column)
            same(node.entries[key.value], value)
    elif isinstance(other, yaml.SequenceNode):
        assert isinstance(node.content, tuple)
        for item, value in zip(node.items, other.value, strict=True):
            same(item, value)
    elif node.text is not None or other.style is not None:  # a plain one may be a number
        assert node.text == other.value


def test_places_and_texts_are_those_of_the_yaml_composer() -> None:
    root, found = tree(TEXT)
    assert found == []
    assert root is not None
    same(root, yaml.compose(TEXT, yaml.SafeLoader))
    assert root.get("list", 1, "b").number == -1500.0
    assert root.get("scene", "bodies", "quoted key").content is None


@pytest.mark.parametrize(
    ("marked", "sentence"),
    [
        ("a: 1\n§a: 2", 'key "a" stands twice, first in line 1'),
        ("{§[1]: 2}", "a key is a list, a mapping or an alias; a key is a name"),
        ("a: §!!python/x 1", 'tag "!!python/x": a config has no tags, only plain values'),
        (
            "a: §&x 1",
            "anchor &x: anchors and aliases are not read; write the value out where it is used",
        ),
        ("a: §*x", "alias *x: there is no such anchor"),
        ('a: §"\\x1b"', "control character U+001B; remove it"),
        ("a: \u00e9§\x07", "control character U+0007; remove it"),
        ("a: 1\n§---\nb: 1", "a second document; a file holds one experiment"),
        ("§", "the file is empty; an experiment has a scene, a duration"),
        ("§# only words", "the file is empty; an experiment has a scene, a duration"),
        ("a: " + "[" * (DEEPEST - 1) + "§[" + "]" * DEEPEST, "nested deeper than 32 levels"),
    ],
)
def test_what_no_config_has_is_refused_at_its_place(marked: str, sentence: str) -> None:
    text, (place,) = marked_places(marked)
    assert tree(text)[1] == [f"{place}: {sentence}"]


def test_the_first_value_of_a_key_that_stands_twice_is_kept() -> None:
    root, _ = tree("{a: 1, a: {b: 2}, c: 3}")
    assert root is not None
    assert root.data == {"a": 1, "c": 3}


def test_a_mapping_with_a_refused_key_is_incomplete_and_a_bad_scalar_broken() -> None:
    root, _ = tree("{a: {[1]: 2, b: 3}, c: .nan}")
    assert root is not None
    assert root.get("a").incomplete
    assert not root.incomplete
    assert root.get("a", "b").number == 3
    assert root.get("c").content is BROKEN


def test_keys_are_text_and_values_are_numbers() -> None:
    root, _ = tree("1: 1\ntrue: true\n0.5: '0.5'")
    assert root is not None
    assert root.data == {"1": 1, "true": True, "0.5": "0.5"}


def test_as_many_values_as_there_may_be() -> None:
    """The mapping, its key, the list and its items are values."""
    most = MOST_VALUES - 3
    assert tree("a: [" + "1," * most + "]")[1] == []
    text, (place,) = marked_places("a: [" + "1," * most + "§1]")
    assert tree(text)[1] == [f"{place}: more than {MOST_VALUES} values in one file"]


def test_bytes_that_are_no_text_are_refused_where_they_stand() -> None:
    said = "byte 0xff is not UTF-8; save the file as UTF-8"
    assert tree(b"a: 1\n\xc3\xa9: \xff")[1] == [f"2:4: {said}"]
    assert tree("a: 1".encode("utf-16"))[1] == ["1:1: the file is UTF-16; save it as UTF-8"]
    report = Report("f")
    assert parse(b"a: 1", report, size=(1 << 20) + 1) is None
    assert [defect.message for defect in report.defects] == [
        "the file has 1048577 bytes; a config has at most 1 MiB"
    ]
    assert decode(b"\xef\xbb\xbfa: 1") == "a: 1"


def test_defects_of_a_file_beside_the_config_name_that_file() -> None:
    report = Report("f")
    parse(b"a: 1\na: 2", report, file="base.yaml")
    assert [str(defect) for defect in report.defects] == [
        'base.yaml:2:1: key "a" stands twice, first in line 1'
    ]


def test_the_collector_of_garbage_is_left_as_it_was() -> None:
    tree("a: [1")  # a text that breaks off
    assert gc.isenabled()
    gc.disable()
    try:
        tree("a: 1")
        assert not gc.isenabled()
    finally:
        gc.enable()
