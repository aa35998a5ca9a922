"""About how many bytes a log will have, before it is written.

    size = steps (16 messages + sum of k numbers left by zstd) + what stands in every log

Names, tags and lengths are the same in every message: zstd leaves next to nothing of them. Of the
numbers it leaves a share that depends on what the scene does: of a stack at rest a tenth, of a pile
that churns most. The shares here lie between, as measured (level 1) on shipped configs:

    numbers of          at rest     falling     churning    taken
    /step, /plot        0.6         0.3         0.8         SHARE_OF_STEP
    /tf                 0.4         0.4         1.0         SHARE_OF_POSE
    contacts            0.1         -           0.5         SHARE_OF_CONTACT
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Final, NamedTuple

import numpy as np

from lavendersim.trace import layout
from lavendersim.trace.contact_columns import column_form
from lavendersim.trace.points import point_form
from lavendersim.trace.wire import INDEX_ENTRY

WORD: Final = 8  # [B] of a number
SHARE_OF_STEP: Final = 0.5
SHARE_OF_POSE: Final = 0.7
SHARE_OF_CONTACT: Final = 0.22
# Resolved config, body by body, is written as it is: 920 B each in shipped scenes of 2 to 1005.
BYTES_PER_BODY: Final = 920
# Schemas, channels, the plan's reasons and versions, in each of the same scenes.
FRAMEWORK: Final = 11_000
EVERY_RUN = "/robot_description"  # the one topic without a message a step


class StepContent(NamedTuple):
    """What the messages of one step hold, on the average over a run."""

    step_columns: int
    contact_columns: Sequence[tuple[str, str]]  # name and numpy kind of each
    moving: float  # bodies whose pose changes and is recorded
    contacts: float  # that are recorded
    sweeps: float = 0.0  # whose residuals are logged


def expected_size(
    content: StepContent, topics: Collection[str], steps: int, bodies: int, as_written: str
) -> float:
    """Return about how many bytes [B] the log of so many steps takes; topics: those that it has."""
    numbers = content.step_columns * WORD * SHARE_OF_STEP
    if "/tf" in topics:
        numbers += content.moving * layout.POSE * WORD * SHARE_OF_POSE
    if "/velocities" in topics:
        numbers += content.moving * layout.VELOCITY * WORD * SHARE_OF_POSE
    if "/contacts" in topics:
        row = np.dtype(list(content.contact_columns))
        point = point_form(row).size + WORD * len(column_form(row).names)
        numbers += content.contacts * point * SHARE_OF_CONTACT
    # a sweep has its number and its residual, and what repeats is gone
    numbers += content.sweeps * WORD
    each_step = [topic for topic in topics if topic not in (EVERY_RUN, "/residuals")]
    indexes = INDEX_ENTRY.itemsize * (len(each_step) + (content.sweeps > 0.0))
    rows = steps + 1  # with the initial state
    fixed = FRAMEWORK + len(as_written.encode()) + bodies * BYTES_PER_BODY
    return rows * (numbers + indexes) + fixed
