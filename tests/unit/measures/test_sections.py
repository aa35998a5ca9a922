"""Sections of a log are its states, each once, with contacts and poses, wherever parts end."""

from __future__ import annotations

import tracemalloc
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from lavendersim.errors import TraceError
from lavendersim.measures.sections import sections_of
from tests.unit.measures.synthetic import SyntheticTrace, contacts, poses, steps

STATES = 200


class Parted(SyntheticTrace):
    """A log whose topics come in parts, cut at places of their own; drawn by a seed."""

    seed = 0
    absent: Any = {}  # noqa: RUF012 - as a log's

    def _cuts(self, topic: int, most: int) -> np.ndarray:
        rng = np.random.default_rng([self.seed, topic])
        return np.sort(rng.integers(0, most + 1, rng.integers(0, 8)))

    def steps_in_parts(self) -> Iterator[Any]:
        yield from np.split(self.step, self._cuts(0, len(self.step)))

    def poses_in_parts(self) -> Iterator[tuple[Any, Any]]:
        cuts = self._cuts(1, len(self.pose))
        numbers = self.step["step"][: len(self.pose)]
        yield from zip(np.split(numbers, cuts), np.split(self.pose, cuts), strict=True)

    def contacts_in_parts(self) -> Iterator[Any]:
        edges = np.searchsorted(self.contact["step"], self._cuts(2, STATES))
        yield from np.split(self.contact, edges)


def log(seed: int, states: int = STATES) -> Parted:
    """States of which about a third have contacts, up to three each."""
    rng = np.random.default_rng(seed)
    counts = rng.integers(1, 4, states) * (rng.random(states) < 0.3)
    rows = [(step, float(step), 0.0) for step in np.repeat(np.arange(states), counts).tolist()]
    heights = np.arange(states, dtype=float)
    made = Parted(steps(heights), contacts(rows), poses(heights))
    made.seed = seed
    return made


@pytest.mark.parametrize("whole", [True, False])
@pytest.mark.parametrize("seed", range(25))
def test_every_state_stands_in_one_section_with_its_contacts_and_pose(
    seed: int, whole: bool
) -> None:
    trace = log(seed)
    count, seen, touching = 0, [], []
    for section in sections_of(trace, whole):
        before = section.before
        assert before == count
        again = 1 if before else 0  # a section begins with the last state before it
        numbers = section.step["step"]
        assert numbers.tolist() == list(range(before - again, before - again + len(numbers)))
        np.testing.assert_array_equal(section.pose[:, 1, 2], trace.pose[numbers, 1, 2])
        assert set(section.contact["step"]) <= set(numbers[again:])
        seen += numbers[again:].tolist()
        touching += section.contact["impulse_n"].tolist()
        count += len(numbers) - again
    states = STATES - (0 if whole else 1)
    assert seen == list(range(states))
    mine = trace.contact["step"] < states
    assert touching == trace.contact["impulse_n"][mine].tolist()


def test_a_log_without_states_or_with_one_that_does_not_count_has_no_section() -> None:
    assert list(sections_of(log(0, 0), True)) == []
    assert list(sections_of(log(0, 1), False)) == []


def test_a_log_without_poses_or_contacts_has_sections_all_the_same() -> None:
    trace = log(3)
    trace.absent = {"/tf": "not recorded"}
    trace.contact = trace.contact[:0]
    found = list(sections_of(trace, True))
    assert sum(len(section.contact) for section in found) == 0
    assert {section.pose.shape[1] for section in found} == {0}


def test_poses_of_other_steps_are_no_log_s() -> None:
    trace = log(4)
    trace.pose = trace.pose[:-1]
    with pytest.raises(TraceError, match="other steps"):
        list(sections_of(trace, True))


def test_memory_is_that_of_parts_and_not_of_the_log() -> None:
    """Parts of 100 states: of 20 times as many states the same bytes are in use at the most."""

    class Endless(Parted):
        parts = 0

        def steps_in_parts(self) -> Iterator[Any]:
            for part in range(self.parts):
                rows = steps(np.zeros(100))
                rows["step"] += 100 * part
                yield rows

        def poses_in_parts(self) -> Iterator[tuple[Any, Any]]:
            for rows in self.steps_in_parts():
                yield rows["step"], poses(np.zeros(len(rows)))

        def contacts_in_parts(self) -> Iterator[Any]:
            for rows in self.steps_in_parts():
                yield contacts([(step, 1.0, 0.0) for step in rows["step"].tolist()])

    def peak(parts: int) -> int:
        trace = Endless(steps([]), contacts([]), poses([]))
        trace.parts = parts
        tracemalloc.start()
        for _ in sections_of(trace, True):
            pass
        used = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return used

    peak(3)  # what numpy keeps of its first use
    assert peak(200) <= 1.1 * peak(10)
