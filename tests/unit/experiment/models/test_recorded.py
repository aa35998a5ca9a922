"""Measures and panels of every step are refused where the log has not every step."""

from __future__ import annotations

import pytest

from lavendersim.experiment.models.recorded import not_recorded
from lavendersim.experiment.text.parse import parse
from lavendersim.experiment.text.report import Report
from lavendersim.quantities.readings import CONTACTS, POSES, SUMS, VELOCITIES
from tests.marked_config import assert_refused, config, refusals

PEAK = "{kind: peak_force, body: ball}"


def reason(record: str, taken: frozenset[str]) -> str | None:
    root = parse(f"record: {record}".encode(), Report(""))
    assert root is not None
    return not_recorded(root, taken)


@pytest.mark.parametrize("record", ["{}", "{contacts: all}", "{poses: every 2}"])
def test_contacts_of_every_step_can_be_taken(record: str) -> None:
    assert reason(record, CONTACTS) is None


def test_the_reason_names_the_section_and_what_it_has_instead() -> None:
    some = "takes the contacts of every step, and record.contacts is"
    assert reason("{contacts: every 4}", CONTACTS) == f"{some} every 4"
    assert reason("{contacts: {from: 0.5, to: 2}}", CONTACTS) == f"{some} from 0.5 to 2 s"
    both = reason("{contacts: every 4, poses: every 2}", CONTACTS | POSES)
    assert both == f"{some} every 4"  # one reason is enough
    assert reason("{contacts: every 4, poses: every 2}", SUMS) is None
    assert reason("{poses: every 2}", VELOCITIES) is not None


def test_a_measure_and_a_panel_are_refused_at_their_kind() -> None:
    why = "takes the contacts of every step, and record.contacts is every 4; expected all"
    measured = config(record="{contacts: every 4}", measure=f"{{f: {PEAK}}}")
    marked = measured.replace("kind: peak_force", "kind: §peak_force")
    assert_refused(marked, f"kind: peak_force {why}")
    assert refusals(config(record="{contacts: all}", measure=f"{{f: {PEAK}}}")) == []


def test_a_measure_of_velocities_needs_them_recorded() -> None:
    measure = "{v: {kind: §velocity, body: ball, time: 0.5, along: [0, 0, 1]}}"
    assert_refused(
        config(measure=measure),
        "kind: velocity takes velocities, and record.velocities is false; expected true",
    )
    recorded = config(measure=measure.replace("§", ""), record="{velocities: true}")
    assert refusals(recorded) == []
