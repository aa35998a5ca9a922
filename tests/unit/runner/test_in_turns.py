"""Generators in turns: stage by stage, results in order, and an error ends all of them."""

from __future__ import annotations

from collections.abc import Generator

import pytest

from lavendersim.runner.in_turns import in_turns, with_growth


def nothing(asked: list[object]) -> list[object]:
    raise AssertionError(f"{asked}: nobody asks for anything")


def counted(name: str, stages: int, seen: list[str]) -> Generator[None, None, str]:
    try:
        for stage in range(stages):
            seen.append(f"{name}{stage}")
            yield
        if name == "x":
            raise OSError(name)
        seen.append(f"{name}.")
    finally:
        seen.append(f"{name} closed")
    return name


def test_a_stage_of_each_comes_before_the_next_stage_of_any() -> None:
    seen: list[str] = []
    found = in_turns([counted("a", 2, seen), counted("b", 0, seen), counted("c", 1, seen)], nothing)
    assert found == ["a", "b", "c"]
    stages = [one for one in seen if "closed" not in one]
    assert stages == ["a0", "b.", "c0", "a1", "c.", "a."]


def test_none_are_none() -> None:
    assert in_turns([], nothing) == []


def test_what_one_raises_is_raised_once_the_others_are_closed() -> None:
    seen: list[str] = []
    with pytest.raises(OSError, match="x"):
        in_turns([counted("a", 3, seen), counted("x", 1, seen), counted("b", 3, seen)], nothing)
    assert [one for one in seen if "closed" in one] == ["x closed", "a closed", "b closed"]
    assert "b1" not in seen


def test_what_is_asked_for_in_one_turn_is_answered_at_once() -> None:
    def asking(*numbers: int) -> Generator[int | None, int | None, list[int | None]]:
        yield None
        found = []
        for number in numbers:
            found.append((yield number))  # noqa: PERF401 - comprehensions cannot yield
        return found

    asked: list[list[int]] = []

    def squares(numbers: list[int]) -> list[int]:
        asked.append(numbers)
        return [number**2 for number in numbers]

    assert in_turns([asking(2, 3), asking(), asking(0)], squares) == [[4, 9], [], [0]]
    assert asked == [[2, 0], [3]]


def test_what_a_reading_grows_by_between_its_stages_is_not_its_own() -> None:
    read = [0]

    def stages(own: int) -> Generator[str, int, int]:
        read[0] += own
        answer = yield "what"
        read[0] += 10 * own
        return answer

    grown = [with_growth(stages(own), lambda: read[0]) for own in (1, 2)]
    assert in_turns(grown, lambda asked: [len(one) for one in asked]) == [(4, 11), (4, 22)]


def test_a_generator_whose_growth_is_read_is_closed_with_it() -> None:
    seen: list[str] = []
    going = with_growth(counted("a", 3, seen), lambda: 0)
    next(going)
    going.close()
    assert seen == ["a0", "a closed"]
