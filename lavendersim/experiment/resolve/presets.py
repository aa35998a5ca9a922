"""The named sets of numerics; a config takes one by name and may change single values.

`chapter` is frozen: the checks of configs/chapter and configs/paw_check are compared with it.
`default`, what a config gets that names none, is lavender's own and may become better.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from types import MappingProxyType
from typing import Final

from lavendersim.cell.numerics import Numerics
from lavendersim.experiment.text.node import UNWRITTEN, Mark, Node, graft
from lavendersim.quantities.scalars import Ratio

DEFAULT: Final = Numerics()
# Source: the contact chapter (240 Hz, 22 sweeps, warm start, captured restitution above 2 g dt,
# projection by a fifth). The chapter prints neither gain nor slop; with 0.02 and 1 mm a drop with
# e = 0.8 at 480 Hz rebounds to 0.650..0.676 m here over release phases; it prints 0.659 m.
CHAPTER: Final = Numerics(
    timestep=Fraction(1, 240),
    accuracy=None,
    smallest_timestep=1e-9,
    solver="projected_gauss_seidel",
    sweeps=22,
    over_relaxation=1.0,
    order="coloured",
    tolerance=None,
    warm_start=True,
    stabilisation_gain=0.02,
    slop=0.001,
    projection=0.2,
    projection_sweeps=22,
    restitution_threshold=2.0,
    cache_distance=0.02,
    cache_normal_cosine=0.95,
    speculative=False,
    impacts="captured",
    simultaneous_impacts="together",
    integrator="semi_implicit_euler",
    compliance_law="regularised",
    undetermined_forces="as_solved",
    friction_cone="disc",
    sleeping=False,
    sleep_speed=0.005,
    sleep_time=0.5,
)
PRESETS: Final[MappingProxyType[str, Numerics]] = MappingProxyType(
    {"chapter": CHAPTER, "default": DEFAULT}
)


def specified_numerics(root: Node) -> tuple[str, dict[str, Node]]:
    """Return the preset that a config names, and the values beside it, as written."""
    return _specified(root.get("numerics"))


def _specified(numerics: Node) -> tuple[str, dict[str, Node]]:
    values = dict(numerics.entries)
    preset = values.pop("preset", numerics)
    return preset.text or "default", values


def with_named_preset(root: Node) -> Node:
    """Return the tree with `numerics: chapter` written as {preset: chapter}."""
    numerics = root.get("numerics")
    if numerics.text is None:
        return root
    opened = Node({"preset": numerics}, numerics.mark, {"preset": numerics.mark})
    return graft(root, ("numerics",), opened)


def with_preset(root: Node) -> Node:
    """Return the tree with the preset's numbers in its numerics, below those that are written.

    null is a value for `tolerance` (never stop early) and says nothing anywhere else.
    """
    whole = _with_preset(root.get("numerics"), root.mark)
    return root if whole is None else graft(root, ("numerics",), whole)


@lru_cache(maxsize=64)  # by the node itself: cells of a sweep of other things have one
def _with_preset(numerics: Node, otherwise: Mark) -> Node | None:
    """Return numerics with the preset's numbers; None: refused by the model.

    otherwise: where they stand that are not written.
    """
    name, values = _specified(numerics)
    named = PRESETS.get(name)
    wrong = numerics and numerics.text is None and not numerics.entries
    if named is None or wrong:
        return None
    entries = {
        key: Node(Ratio(value) if isinstance(value, Fraction) else value, UNWRITTEN)
        for key, value in named
    }
    given = {k: v for k, v in values.items() if v.content is not None or k == "tolerance"}
    return replace(
        numerics or Node({}, otherwise),
        content=entries | {"preset": Node(name, UNWRITTEN)} | given,
    )
