"""Defects of a file: each place once, in the order of the file, those it extends behind."""

from __future__ import annotations

from lavendersim.experiment.text.node import Mark
from lavendersim.experiment.text.report import MOST_DEFECTS, Report


def lines(report: Report) -> list[str]:
    """Return the defects as they are printed."""
    return [str(one) for one in report.defects]


def test_defects_stand_in_the_order_of_the_file() -> None:
    report = Report("a.yaml")
    report.add(Mark(9, 1), "late")
    report.add(Mark(2, 5), "early, right")
    report.add(Mark(2, 1), "early, left")
    assert lines(report) == [
        "a.yaml:2:1: early, left",
        "a.yaml:2:5: early, right",
        "a.yaml:9:1: late",
    ]


def test_a_place_of_an_earlier_round_is_not_refused_again_but_is_no_sound_one() -> None:
    report = Report("a.yaml")
    report.add(Mark(2, 1), "of the file")
    assert not report.close_round()
    assert report.close_round()  # an empty one
    report.add(Mark(2, 1), "of a cell")
    assert not report.close_round()
    report.doubt()
    assert not report.close_round()
    assert lines(report) == ["a.yaml:2:1: of the file"]


def test_one_round_may_say_two_things_of_a_place_each_once() -> None:
    report = Report("a.yaml")
    for text in ("one", "other", "one"):
        report.add(Mark(2, 1), text)
    assert lines(report) == ["a.yaml:2:1: one", "a.yaml:2:1: other"]


def test_files_that_are_extended_come_behind_and_options_do_not() -> None:
    report = Report("z.yaml")
    report.add(Mark(1, 1, "base.yaml"), "base")
    report.add(Mark(1, 1, "--set"), "option")
    report.add(Mark(1, 1), "own")
    assert [line.partition(":")[0] for line in lines(report)] == ["--set", "z.yaml", "base.yaml"]


def test_a_very_long_list_ends_with_how_many_are_left() -> None:
    report = Report("a.yaml")
    for line in range(1, MOST_DEFECTS + 11):
        report.add(Mark(line, 1), "wrong")
    found = lines(report)
    assert len(found) == MOST_DEFECTS
    # 199 are said, 11 are left
    assert found[-1] == f"a.yaml:{MOST_DEFECTS}:1: ... and 11 more defects from here on"
