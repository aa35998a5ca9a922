"""Which rows of the log are of a joint: its own and its stops, whatever features surfaces have."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from interpreted import interpreted

from lavendersim.engine.collide.joint import FIRST_JOINT, ROWS
from lavendersim.engine.effects.joint import make_contact_row
from lavendersim.engine.spec import Spec

EFFECTS = ("compound", "contact_log", "frictionless_contact", "joint", "joint_stop")


@pytest.mark.parametrize(("bilateral", "stop", "joint"), [(1, 0, 3), (0, 1, 3), (0, 0, 0)])
@pytest.mark.parametrize("effects", [EFFECTS, EFFECTS[:-1]], ids=["stops", "no stops"])
def test_a_row_is_of_a_joint_by_what_it_is_and_not_by_its_feature(
    bilateral: int, stop: int, joint: int, effects: tuple[str, ...]
) -> None:
    """Names of features have 20 bits, 38 from the right: those of hulls go beyond 2^49."""
    feature = FIRST_JOINT + 2 * ROWS + 1
    contact = SimpleNamespace(bilateral=bilateral, stop=stop, feature=feature)
    out = SimpleNamespace()
    interpreted(make_contact_row(Spec(effects, (), "adaptive")))(out, contact, None, None)
    assert out.joint == (joint if bilateral or "joint_stop" in effects else 0)
