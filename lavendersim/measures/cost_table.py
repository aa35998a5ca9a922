"""What accuracy costs, as a run keeps it (`cost.json`): a row a setting, and answers to targets.

A number that a setting does not have (it diverged, it was not timed) is None.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Final

from lavendersim.measures.spread import Spread
from lavendersim.measures.typed_tables import plain, read_as
from lavendersim.peers.catalogue import LAVENDER, PEERS, peer_of

ENGINES: Final = (LAVENDER, *PEERS)  # in the order of their looks


@dataclass(frozen=True)
class ErrorSource:
    """What the error of a setting is taken from."""

    measure: str
    truth: Any  # a number, a closed form, or `finest`
    scale: float | None  # None: the largest |truth|


@dataclass(frozen=True)
class CostTruth:
    """The run that all others are compared with."""

    timestep: str  # [s] a ratio: `1/1920`
    solver: str
    sweeps: int
    tolerance: float | None  # [m/s]
    warm_start: bool
    worst_residual: float | None  # [m/s]
    not_converged_steps: int
    steps: int
    failed: str


@dataclass(frozen=True, kw_only=True)
class CostRow:
    """One setting: its numerics, its errors, and what a simulated second of it costs."""

    role: str  # of the grid; the config's own; the chapter's
    preset: str
    timestep: str  # [s] a ratio: `1/240`
    solver: str
    sweeps: int  # at most
    tolerance: float | None  # [m/s]
    warm_start: bool
    accuracy: float | None = None  # None: every step is one timestep long
    error: float | None  # relative, of the worst cell
    least_error: float | None = None  # over perturbed starts, of each the worst cell; None: one
    worst_at: str  # the coordinates of that cell; "" without a sweep
    order: float | None  # observed, against the next coarser timestep
    law: str  # whose problem is solved
    worst_residual: float | None  # [m/s]
    not_converged_steps: int
    steps: int  # of all cells
    failed: str  # why it is no answer; "" where it is one
    ns_per_second: Spread | None  # [ns] of physics per simulated second
    samples: list[float]  # [ns], one a repeat
    timed_seconds: float  # [s] simulated time that is timed, of all its cells
    compile_s: float  # [s] of its engine, once
    fragment: str  # of a config, which gives this setting
    front: bool = False  # whether none of its engine is cheaper and as good
    engine: str = LAVENDER  # or a variant of another, which has no numerics but the timestep
    settings: dict[str, Any] = field(default_factory=dict)  # of that engine, beside the variant's
    contacts: float | None = None  # a step, on average; None: its engine does not report it
    iterations: float | None = None  # a step, likewise

    @property
    def family(self) -> str:
        """The engine whose variant it is."""
        return self.engine if self.engine == LAVENDER else peer_of(self.engine).name

    @property
    def title(self) -> str:
        """The engine as its authors write it."""
        return self.engine if self.engine == LAVENDER else peer_of(self.engine).title

    @property
    def is_lavender(self) -> bool:
        """Whether lavender simulates it, so that it has numerics."""
        return self.engine == LAVENDER

    @property
    def is_own(self) -> bool:
        """Whether it is its engine's own default; of lavender what the config specifies."""
        if self.is_lavender:
            return self.role == "specified"
        own = peer_of(self.engine).own
        return self.engine == self.family and self.settings.items() <= own.items()

    @property
    def is_controlled(self) -> bool:
        """Whether an accuracy was asked for."""
        return self.accuracy is not None

    @property
    def is_answer(self) -> bool:
        """Whether it did not fail and was timed."""
        return not self.failed and self.ns_per_second is not None and self.error is not None

    @property
    def cost(self) -> float:
        """Median cost of a simulated second [ns]; of a setting that was timed."""
        assert self.ns_per_second is not None
        return self.ns_per_second.median


@dataclass(frozen=True)
class CostAnswer:
    """The cheapest setting that reaches a target."""

    target: float  # relative error
    reached: bool
    row: int | None  # index of the setting
    sentence: str
    fragment: str | None  # of a config
    engine: str = LAVENDER  # whose settings are meant


@dataclass(frozen=True, kw_only=True)
class CostTable:
    """A grid of settings: what each costs, and how wrong it is."""

    experiment: str
    config: str  # path of the file
    overrides: list[str] = field(default_factory=list)  # of the command line
    question: str
    error: ErrorSource
    axes: list[str]  # of the experiment's own sweep
    cells_per_setting: int
    clock: str  # what times were taken with
    machine: dict[str, Any]
    repeats: int  # rounds that were taken
    interrupted: str = ""  # what ended them before their time
    quick: bool = False  # whether its grid is coarser than the config's
    begin: float  # [s] simulated time at which timing begins; `from` in the file
    duration: float  # [s] simulated
    truth: CostTruth | None  # None: no run of its own
    rows: list[CostRow]
    targets: list[CostAnswer]  # of several engines one each
    refused: dict[str, str] = field(default_factory=dict)  # engine -> why it cannot do the scene
    sentences: list[str] = field(default_factory=list)  # a target, all engines; of several
    efforts: dict[str, str] = field(default_factory=dict)  # engine -> its iterations, its capacity

    @property
    def engines(self) -> list[str]:
        """The engines that have settings in it, in their order."""
        return list(dict.fromkeys(row.family for row in self.rows))

    @property
    def compares_engines(self) -> bool:
        """Whether another engine has settings in it."""
        return not all(row.is_lavender for row in self.rows)

    @classmethod
    def of(cls, data: dict[str, Any]) -> CostTable:
        """Return a table that was read. ValueError where something in it is missing or wrong."""
        given = {"begin": data.get("from"), **data}
        return read_as(cls, given)

    def as_data(self) -> dict[str, Any]:
        """Return the table as it is written."""
        return {"from" if key == "begin" else key: value for key, value in plain(self).items()}
