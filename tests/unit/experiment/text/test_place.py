"""Names of places in sentences, and what a rule of a mapping may refuse."""

from __future__ import annotations

import pytest

from lavendersim.experiment.text.node import Mark, Node, Path
from lavendersim.experiment.text.place import Place, missing_key, name_of, place_of


@pytest.mark.parametrize(
    ("path", "name", "place"),
    [
        ((), "the file", "the experiment"),
        (("duration",), "duration", "duration"),
        (("scene", "bodies", "ball"), "ball", "scene.bodies.ball"),
        (
            ("scene", "bodies", "ball", "position", 2),
            "position[2]",
            "scene.bodies.ball.position[2]",
        ),
        (("sweep", 0, "e"), "e", "sweep[0].e"),
    ],
)
def test_names_of_values_and_of_mappings(path: Path, name: str, place: str) -> None:
    assert name_of(path) == name
    assert place_of(path) == place


def test_a_missing_key_says_its_meaning_where_it_has_one() -> None:
    assert missing_key("mass", ("ball",), "[kg]") == 'missing key "mass" in ball: [kg]'
    assert missing_key("mass", (), None) == 'missing key "mass" in the experiment'


class Refusals:
    """A mapping in a file, and what was refused there."""

    def __init__(self) -> None:
        self.said: list[tuple[Mark, str]] = []
        content = {"a": Node(1.0, Mark(2, 4)), "b": Node(None, Mark(3, 4))}
        node = Node(content, Mark(1, 1), {"a": Mark(2, 1), "b": Mark(3, 1)})
        doubted = self.said.clear
        self.at = Place(
            node, ("events", 3), node, lambda mark, text: self.said.append((mark, text)), doubted
        )


def test_null_writes_nothing() -> None:
    at = Refusals().at
    assert at.written("a") == Mark(2, 1)
    assert at.written("b") is None
    assert at.written("c") is None
    assert (at.index, str(at)) == (3, "events[3]")


def test_values_that_exclude_each_other_are_refused_at_the_later() -> None:
    found = Refusals()
    one, other = found.at.get("a"), Node(2.0, Mark(9, 9))
    found.at.refuse_pair(one, other, "both")
    found.at.refuse_pair(other, one, "both")
    assert found.said == [(Mark(9, 9), "both")] * 2


def test_a_mapping_is_refused_for_a_key_that_it_lacks() -> None:
    found = Refusals()
    found.at.lacks("at", "[s] when")
    assert found.said == [(Mark(1, 1), 'missing key "at" in events[3]: [s] when')]


def test_of_two_keys_that_exclude_each_other_the_later_is_refused_where_both_are_written() -> None:
    found = Refusals()
    assert [found.at.refuse_both(keys) for keys in (("c", "b"), ("a", "b"))] == [0, 1]
    assert found.said == []
    found.at.node.entries["b"].content = 1.0
    assert dict(found.at.given("cba")) == {"b": Mark(3, 1), "a": Mark(2, 1)}
    assert found.at.refuse_both(("b", "a")) == 2
    assert found.said == [(Mark(3, 1), "events[3] specifies both b and a; keep one")]
