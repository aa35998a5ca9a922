"""What an effect may know of a scene, and what it decides."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Generic, NamedTuple, TypeVar

MOST_PAIRS = 3  # in a sentence


class BodyFacts(NamedTuple):
    """One body as the predicates see it."""

    name: str
    shape: str
    movable: bool
    spins: bool  # it has an initial angular velocity
    round: bool  # all principal inertias equal
    kinematic: bool = False  # keeps its velocity, whatever touches it
    speed: float = 0.0  # largest specified [m/s]
    size: float = 0.0  # radius of the sphere about its centre that holds it [m], planes: inf
    least_size: float = 0.0  # of the smallest of its parts, where it has some; planes: inf
    pulled: bool = False  # an effect with keys of its own in the scene pulls it
    twisted: bool = False  # and turns it
    config: Any = None  # the body as the config of the cell has it
    later: tuple[Any, ...] = ()  # and as events make it, where they change its surface
    force: bool = False  # a force acts on it at some time
    torque: bool = False
    parts: int = 0  # of a compound
    reoriented: bool = False  # an event gives it a new orientation

    @property
    def forms(self) -> tuple[Any, ...]:
        """The body as the config has it and as events make it, in their order."""
        return (self.config, *self.later)


Which = TypeVar("Which", str, int)


class PairFacts(NamedTuple, Generic[Which]):
    """Two bodies that may touch, and what holds between their surfaces.

    Predicates see them by name, the scene by the rows of its body table. Bodies that are alike in
    shape, surface and movability share one entry, under the first of them: the number of entries
    does not grow with the number of bodies.
    """

    a: Which
    b: Which
    surface: Any  # of the contact: the surface keys of the effects, mixed
    shape_pair: str = ""  # name of the manifold
    row_pairs: int = 1  # how many pairs it stands for
    off_centre: bool = False  # a rope or joint that may pull past a centre of mass

    @property
    def is_soft(self) -> bool:
        """Whether its contacts give way under a load."""
        return bool(self.surface.compliance > 0.0 or self.surface.hertz_stiffness > 0.0)

    @property
    def resists_turning(self) -> bool:
        """Whether a contact of the pair passes on a torque of its own."""
        return bool(self.surface.torsional_friction > 0.0 or self.surface.rolling_friction > 0.0)


class Facts(NamedTuple):
    """A scene and its numerics, reduced to what decides which effects are required."""

    bodies: tuple[BodyFacts, ...]
    pairs: tuple[PairFacts[str], ...]
    gravity: tuple[float, float, float]  # as the run begins
    stabilisation_gain: float
    projection: float
    warm_start: bool
    triggers: tuple[str, ...] = ()  # states that make an event happen, in words
    later_gravity: tuple[tuple[float, float, float], ...] = ()  # as events make it
    pair_count: int = 0  # pairs of bodies that may touch
    speculative: bool = False
    impacts: str = "captured"
    simultaneous_impacts: str = "together"
    accuracy: float | None = None  # asked for, relative; None: fixed timesteps
    scene: Any = None  # of the config, for effects with keys of their own in it
    mistake: str = "none"  # a deliberate error, for study
    integrator: str = "semi_implicit_euler"
    compliance_law: str = "regularised"
    undetermined_forces: str = "as_solved"
    friction_cone: str = "disc"
    order: str = "coloured"  # of contacts in a sweep
    over_relaxation: float = 1.0
    sweeps: int = 50  # of a solve, at most
    solver: str = "adaptive"
    sleeping: bool = False
    events: bool = False  # something is changed during the run
    record: bool = True  # the run is logged
    velocities: bool = False  # and velocities of bodies with it
    residuals: bool = False  # and the residual of every sweep, for some steps
    problems: bool = False  # contact problems of some steps are dumped
    timestep: float = 0.0  # [s]
    duration: float = 0.0  # [s]


def meeting(facts: Facts) -> list[PairFacts[str]]:
    """Return the pairs that may meet: not those of joints, which are never apart."""
    return [pair for pair in facts.pairs if pair.shape_pair != "joint"]


class Decision(NamedTuple):
    """Whether an effect is on, and the reason in the scene's own words."""

    on: bool
    reason: str


def named(names: list[str]) -> str:
    """List a few names for a sentence: `ball, box_1 and 3 more`."""
    if len(names) <= 3:
        return ", ".join(names)
    return f"{', '.join(names[:2])} and {len(names) - 2} more"


def by_pair(pairs: Sequence[PairFacts[str]], say: Callable[[PairFacts[str]], str]) -> str:
    """Say something of a few pairs of surfaces: `floor and ball: sliding 0.5; floor and box: none`.

    say: nothing for a pair of which there is nothing to say; such pairs come last.
    """
    texts = [(f"{pair.a} and {pair.b}", say(pair)) for pair in pairs]
    described = [f"{names}: {what}" for names, what in texts if what]
    others = [f"{names}: none" for names, what in texts if not what]
    if len(described) > MOST_PAIRS:
        described[MOST_PAIRS - 1 :] = [f"{len(described) - MOST_PAIRS + 1} more pairs"]
    if len(others) > 1:
        others = [f"{len(others)} other pairs: none"]
    return "; ".join(described + others)
