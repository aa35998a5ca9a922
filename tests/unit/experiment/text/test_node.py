"""Nodes remember where they stand; a value that is not there is ABSENT, which is false."""

from __future__ import annotations

from lavendersim.experiment.text.node import ABSENT, BROKEN, Mark, Node, graft, key_mark

AT = Mark(1, 1)
BALL = Node({"mass": Node(2.0, Mark(3, 9)), "fixed": Node(False, Mark(4, 9))}, Mark(3, 3))
ROOT = Node(
    {"bodies": Node({"ball": BALL}, Mark(2, 3)), "places": Node((Node(1, AT), Node("x", AT)), AT)},
    AT,
    {"bodies": Mark(1, 1)},
)


def test_a_path_goes_through_mappings_and_lists() -> None:
    assert ROOT.get("bodies", "ball", "mass").number == 2.0
    assert ROOT.get("places", 1).text == "x"
    assert ROOT.get() is ROOT


def test_what_is_not_there_is_absent_at_any_depth() -> None:
    for path in (
        ("none",),
        ("bodies", "none", "mass"),
        ("places", 2),
        ("places", -1),
        ("bodies", 0),
    ):
        assert ROOT.get(*path) is ABSENT
    assert not ABSENT
    assert Node(None, AT)  # null stands in the file
    assert (ABSENT.text, ABSENT.number, ABSENT.entries, ABSENT.items) == (None, None, {}, ())


def test_true_is_no_number_and_a_number_no_text() -> None:
    assert Node(True, AT).number is None
    assert Node(True, AT).is_true
    assert not Node(1, AT).is_true
    assert Node(1, AT).text is None


def test_data_are_plain_values() -> None:
    assert ROOT.data == {"bodies": {"ball": {"mass": 2.0, "fixed": False}}, "places": (1, "x")}
    assert Node(BROKEN, AT).data is BROKEN
    assert list(ROOT.texts) == ["x"]


def test_a_value_is_grafted_and_the_tree_before_stays() -> None:
    value = Node(9.0, Mark(7, 7))
    grown = graft(ROOT, ("bodies", "ball", "mass"), value)
    assert grown.get("bodies", "ball", "mass") is value
    assert grown.get("bodies", "ball", "fixed") is BALL.get("fixed")
    assert ROOT.get("bodies", "ball", "mass").number == 2.0
    assert graft(ROOT, ("places", 0), value).data["places"] == (9.0, "x")


def test_mappings_that_are_missing_on_the_way_are_made_where_the_value_stands() -> None:
    value = Node(1.0, Mark(7, 7))
    grown = graft(ROOT, ("numerics", "study", "gain"), value)
    assert grown.get("numerics").data == {"study": {"gain": 1.0}}
    assert key_mark(grown, "numerics") == Mark(7, 7)
    assert key_mark(grown, "bodies") == Mark(1, 1)
    assert key_mark(grown, "none") == grown.mark


def test_a_mark_names_its_own_file_or_the_config() -> None:
    assert str(Mark(2, 3).defect("a.yaml", "wrong")) == "a.yaml:2:3: wrong"
    assert str(Mark(2, 3, "base.yaml").defect("a.yaml", "wrong")) == "base.yaml:2:3: wrong"
