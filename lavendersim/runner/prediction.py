"""What a run will take, before it begins: cells, steps, bytes and time.

Bytes are those of `log_size`. The time is a rough one, of steps and expected contacts at the speed
of one core of a desktop: within some three times for scenes of the docs' tables, without compiling.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final, NamedTuple

from lavendersim.experiment import Experiment
from lavendersim.experiment.cell import alike
from lavendersim.scene.expected_contacts import expected_contacts

from .log_size import LogSpace, free_bytes, is_certainly_small, log_space
from .planning import are_shared
from .plans import shared_plans

if TYPE_CHECKING:
    from lavendersim.cell import CellConfig
    from lavendersim.scene.plan import Plan

    from .cell_jobs import Prepared

# Of docs/results.md, with logging: a ball 2.7 us a step; a pile, a pyramid 0.5 to 2.5 us a contact.
PER_STEP: Final = 2.7e-6  # [s]
PER_CONTACT: Final = 1.5e-6  # [s] and step
PER_CELL: Final = 4e-3  # [s]
# Of another engine: its process, loaded anew (0.35 to 0.8 s); a step of a ball (1.3 to 17 us) with
# what is read and sent of it; a contact, 1 us (MuJoCo) to 60 us (Drake). The middle of six engines.
PER_PROCESS: Final = 0.5  # [s]
PER_STEP_ELSEWHERE: Final = 50e-6  # [s]
PER_CONTACT_ELSEWHERE: Final = 4e-6  # [s] and step
MOST_SAMPLED: Final = 100  # cells whose contacts are counted; the others are taken to be like them
MOST_CONTACTS: Final = 20  # of a body, by far
WORTH_SAYING: Final = 60.0  # [s]
LONGEST: Final = 3600.0  # [s] that nobody is asked about


class Prediction(NamedTuple):
    """What a run will take, about."""

    name: str  # of the experiment
    cells: int
    steps: int
    seconds: float  # by the clock on the wall
    space: LogSpace

    @property
    def is_long(self) -> bool:
        """Whether it takes more than an hour."""
        return self.seconds > LONGEST

    @property
    def is_worth_saying(self) -> bool:
        """Whether somebody would want to know it before."""
        return self.seconds > WORTH_SAYING or self.space.is_large


def is_short(experiment: Experiment, root: Path) -> bool:
    """Whether a run is certainly not worth a word: known at once, without expected contacts.

    They are bounded by MOST_CONTACTS a body, as the bytes of `log_size` are.
    """
    cells = experiment.cells()
    seconds = 0.0
    for one in alike(cells):
        config = one[0].config
        seconds += len(one) * seconds_of(config, MOST_CONTACTS * len(config.scene.bodies))
    if seconds > min(WORTH_SAYING, LONGEST):
        return False
    return is_certainly_small(cells, free_bytes(root))


def seconds_of(config: CellConfig, contacts: float) -> float:
    """Return what a cell takes in one process [s], with so many contacts a step."""
    if config.engine is None:
        return PER_CELL + config.steps * (PER_STEP + PER_CONTACT * contacts)
    return PER_PROCESS + config.steps * (PER_STEP_ELSEWHERE + PER_CONTACT_ELSEWHERE * contacts)


def planned_before(experiment: Experiment, jobs: int) -> Prepared | None:
    """Return an experiment with its plans where several processes make them; None: others wait.

    Who predicts a run looks at all its cells, and one process builds them one after the other.
    """
    if not are_shared(experiment.cells(), jobs):
        return None
    from .cell_jobs import prepare  # late: numba

    return prepare(experiment, jobs)


def predicted_together(
    runs: Sequence[Experiment], root: Path, jobs: int = 1, known: Sequence[Prepared] = ()
) -> Prediction | None:
    """Return what the runs that one experiment leads to will take, one after the other.

    None: each is certainly short. root, jobs: as of `predicted`. known: those that are planned.
    """
    if all(is_short(one, root) for one in runs):
        return None
    plans = {id(one.experiment): one.plans for one in known}
    each = [predicted(one, root, jobs, plans.get(id(one))) for one in runs]
    sizes = [one.space.size for one in each if one.space.size is not None]
    return Prediction(
        runs[0].name,
        sum(one.cells for one in each),
        sum(one.steps for one in each),
        sum(one.seconds for one in each),
        LogSpace(sum(sizes) if sizes else None, each[0].space.free),
    )


def predicted(
    experiment: Experiment, root: Path, jobs: int = 1, plans: Sequence[Plan] | None = None
) -> Prediction:
    """Return what a run of an experiment into a folder will take; jobs: its processes.

    plans: of its cells, where they are known.
    """
    cells = experiment.cells()
    steps = sum(len(one) * one[0].config.steps for one in alike(cells))
    sampled = cells[:: max(1, len(cells) // MOST_SAMPLED)]
    work = sum(seconds_of(one.config, expected_contacts(one.config)) for one in sampled)
    seconds = work * len(cells) / len(sampled)
    seconds /= min(jobs, len(cells))
    space = log_space(
        *(cells, lambda: plans or shared_plans(cells), experiment.text, root),
        always=seconds > WORTH_SAYING,
    )
    return Prediction(experiment.name, len(cells), steps, seconds, space)
