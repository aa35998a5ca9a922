"""What an engine declares of itself; one `PEER` a file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated, Any, Final, NamedTuple

from lavendersim.quantities.quantity import Quantity

Value = float | int | str | bool
# Of iterations, sweeps and the like: what a C `int` of 32 bits holds.
Count = Annotated[int, Quantity(whole=True, minimum=1, maximum=2**31 - 1)]

# What of a contact an engine may tell: a point, a unit normal from A to B, the gap [m]; the normal
# impulse on B, the tangential one as a vector in world axes [N s]; the coefficient that it used.
POINT: Final = ("x", "y", "z", "nx", "ny", "nz", "separation")
IMPULSE: Final = ("impulse_n",)
TANGENTIAL: Final = ("px", "py", "pz")
FRICTION: Final = ("friction",)


@dataclass(frozen=True, kw_only=True)
class EngineSetting:
    """One setting of an engine: a key of its section under `engines`."""

    name: str
    type: Any  # annotated with its quantity, or a Literal
    doc: str  # unit and meaning
    default: None = None  # as the variant has it


@dataclass(frozen=True, kw_only=True)
class Variant:
    """One set of settings of an engine, with the reason for it."""

    doc: str
    settings: Mapping[str, Value] = field(default_factory=dict)
    reported: tuple[str, ...] | None = None  # of contacts; None: as its engine


class Knobs(NamedTuple):
    """What `lavender cost` varies of a variant beside the timestep: all its values together."""

    variant: str
    values: Mapping[str, tuple[Value, ...]] = {}  # by setting; none: it stands as it is


@dataclass(frozen=True, kw_only=True)
class Peer:
    """An engine: what a config may ask of it, and which law it solves."""

    name: str
    title: str  # as its authors write it
    package: str  # of the registry, and of `pip install`
    tried: tuple[str, ...]  # versions of the package that the tests have run
    law: str  # of contact, in a sentence: cone or pyramid, convex or not, restitution
    double: bool  # precision of its numbers
    variants: Mapping[str, Variant]  # `mujoco`, `mujoco-stiff`: the first has its own defaults
    settings: tuple[EngineSetting, ...]
    swept: tuple[Knobs, ...]  # by `lavender cost`; the variant of its own defaults is among them
    # What an engine has by itself of a setting that `swept` varies in that variant.
    own: Mapping[str, Value] = field(default_factory=dict)
    shapes: frozenset[str]
    surface_keys: frozenset[str]  # of surfaces, that it obeys
    # By surface key the rule (`mixing.RULES`) by which it mixes two bodies; one that is missing is
    # given to it pair by pair, or is no key of its own.
    mixing: Mapping[str, str] = field(default_factory=dict)
    forces: bool = False  # constant ones at the centre of mass, for a while
    reported: tuple[str, ...] = ()  # of contacts, of the above; none: it reports no contact
    momentum: bool = False  # its impulses are all that acts beside gravity and forces of a step
    counted: bool = False  # its adapter counts the iterations of each step (`World.iterations`)
    iterations: str = ""  # what these are; or how many a step has, where it does not count them
    bounded: bool = False  # its adapter reports where contacts had no room (`World.is_full`)
    capacity: str = ""  # for how many contacts it has room, and what becomes of more
    repeats: str = ""  # whether two runs agree to the bit, in words

    def reports(self, engine: str) -> tuple[str, ...]:
        """Return what a variant reports of contacts."""
        reported = self.variants[engine].reported
        return self.reported if reported is None else reported
