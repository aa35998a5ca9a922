"""The two engines of every effect whose difference in time is its overhead.

Off and on differ in one effect. What the effect needs is in both, so that overheads add up: rolling
friction is measured on top of friction. Where there is no such pair, a sentence says why:
    the numerics chose it, or chose otherwise     another law, no overhead of carrying one
    other effects of the plan need it             it cannot be left out alone
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final, NamedTuple

from lavendersim.cell import CellConfig
from lavendersim.engine.effects import BY_NAME, EFFECTS, Effect, Facts
from lavendersim.engine.spec import Spec
from lavendersim.scene.facts import facts_of
from lavendersim.scene.laws import choice, has_law, is_law, needs
from lavendersim.scene.plan import plan_of

ALL: Final = "all effects"
ALL_RECORDED: Final = "all effects, recorded"


class EnginePair(NamedTuple):
    """Two engines that differ in an effect; without them, why there are none."""

    effect: str
    required: bool
    reason: str  # of the plan
    of_contacts: bool  # it works on contacts; else on bodies
    off: Spec | None = None
    on: Spec | None = None
    on_top_of: tuple[str, ...] = ()  # what both have beyond the scene's own plan
    why_not: str = ""


class Plans(NamedTuple):
    """What the pairs of one scene are made of."""

    facts: Facts
    silent: Spec  # the scene's own plan, nothing recorded
    logged: Spec  # the scene's own plan


def names_of_effects() -> tuple[str, ...]:
    """Return every effect, in the order of the step."""
    return tuple(BY_NAME)


def pairs_of(config: CellConfig, names: Iterable[str] = ()) -> list[EnginePair]:
    """Return a pair for each named effect, for all without names, and for all effects at once."""
    logged = plan_of(config)
    plans = Plans(facts_of(config), plan_of(config, record=False).spec, logged.spec)
    asked = set(names) or set(BY_NAME)
    pairs = [
        _pair(effect, logged.decisions[effect.name].reason, plans)
        for effect in EFFECTS
        if effect.name in asked
    ]
    if names:
        return pairs
    return [*pairs, *_everything(plans)]


def _pair(effect: Effect, reason: str, plans: Plans) -> EnginePair:
    name = effect.name
    on = plans.logged.has(name)
    pair = EnginePair(name, on, reason, of_contacts(effect))
    if effect.overhead_with:
        return pair._replace(why_not=f"timed with {effect.overhead_with}: see there")
    chosen = [each for each in (name, *needs(name)) if not has_law(each, plans.facts)]
    if on and is_law(name):
        key, section, _ = choice(name)
        return pair._replace(why_not=f"chosen by {section}.{key}: another law without")
    if chosen:
        key, section, _ = choice(chosen[0])
        through = "" if chosen[0] == name else f" through {chosen[0]}"
        return pair._replace(why_not=f"{section}.{key} chooses another law{through}")
    base = plans.logged if _is_log(effect) else plans.silent
    there = {name, *needs(name), *base.effects}
    together = (
        name,
        *(
            other.name
            for other in EFFECTS
            if other.overhead_with == name and there.issuperset(needs(other.name))
        ),
    )
    if not on:
        off = base.including(*needs(name))
        added = tuple(each for each in needs(name) if not base.has(each))
        return pair._replace(off=off, on=off.including(*together), on_top_of=added)
    needing = [other for other in base.effects if name in needs(other) and other not in together]
    if needing and _is_log(effect):  # other logs: of a plan without any it is the first
        return pair._replace(off=plans.silent, on=plans.silent.including(*together))
    if needing:
        verb = "needs" if len(needing) == 1 else "need"
        return pair._replace(why_not=f"{', '.join(needing)} {verb} it")
    return pair._replace(off=base.without(*together), on=base)


def _everything(plans: Plans) -> list[EnginePair]:
    """Return the plan against an engine with all effects that the numerics' laws agree with."""
    agreeing = [
        effect
        for effect in EFFECTS
        if all(has_law(each, plans.facts) for each in (effect.name, *needs(effect.name)))
    ]
    physics = [effect.name for effect in agreeing if not _is_log(effect)]
    logs = [effect.name for effect in agreeing if _is_log(effect)]
    whole = plans.silent.including(*physics)
    reason = "every effect whose law the numerics have, idle where the scene does not require it"
    return [
        EnginePair(ALL, False, reason, False, plans.silent, whole),
        EnginePair(ALL_RECORDED, False, reason, False, plans.silent, whole.including(*logs)),
    ]


def of_contacts(effect: Effect) -> bool:
    """Whether an effect works on contacts; otherwise it works on bodies."""
    return effect.per == "contact"


def _is_log(effect: Effect) -> bool:
    """Whether it is a log, or looks at one."""
    return any(BY_NAME[name].channels is not None for name in (effect.name, *needs(effect.name)))
