"""Names of entities and frames of a log: its own where several share a recording."""

from __future__ import annotations

from lavendersim.replay.layer import ALONE, Layer


def test_a_log_alone_has_no_name_before_its_paths() -> None:
    assert ALONE.path("bodies", "ball") == "/bodies/ball"
    assert ALONE.frame("ball") == "ball"


def test_logs_beside_each_other_have_one_each() -> None:
    a, b = Layer("a"), Layer("b")
    assert a.path("bodies", "ball") == "/a/bodies/ball"
    assert a.frame("ball") == "a:ball" != b.frame("ball")


def test_names_are_escaped() -> None:
    assert ALONE.path("bodies", "low ball/1") == "/bodies/low\\ ball\\/1"
