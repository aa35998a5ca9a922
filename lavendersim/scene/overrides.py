"""The effects that a config switches by hand, against what its scene requires.

    on    an effect that is not required is compiled in, with the coefficients that the scene
          specifies, and so is whatever it needs
    off   where the scene does not require it: nothing changes, the file asserts the pruning;
          where it does: refused, unless the file says `force: true`
An effect that a key of the numerics chooses, or of `study`, is another law, no idle effect: only
that key switches it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Final, Literal, NamedTuple, get_args

from lavendersim.cell import CellEffects, CellStudy, Numerics
from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.effects import BY_NAME, Decision, Facts
from lavendersim.errors import UsageError
from lavendersim.quantities.found import nearest, quoted

from .laws import BUSY, choice, has_law, is_law, needs

_LOGS = ("step_log", "pose_log")  # without them nothing of a run can be read

# Sections of a config whose keys choose laws.
SECTIONS: Final[dict[str, Any]] = {"numerics": Numerics, "study": CellStudy}

Forced = Literal["forced on", "forced off"]


class Refusal(NamedTuple):
    """A switch that cannot be: a key of the section `effects`, and why."""

    name: str
    sentence: str


class OverrideError(UsageError):
    """The section `effects` of a config asks for what cannot be; carries every refusal."""

    def __init__(self, refusals: list[Refusal]) -> None:
        self.refusals = tuple(refusals)
        super().__init__("\n".join(refusal.sentence for refusal in refusals))


class Overridden(NamedTuple):
    """What is on once the switches have been followed."""

    effects: dict[str, Decision]
    shape_pairs: dict[str, Decision]
    forced: dict[str, Forced]  # what the scene does not require, or does and does not get


def override(
    effects: Mapping[str, Decision],
    shape_pairs: Mapping[str, Decision],
    facts: Facts,
    section: CellEffects,
) -> Overridden:
    """Follow the switches of a config; raises OverrideError with all that cannot be."""
    made = Overridden(dict(effects), dict(shape_pairs), {})
    refusals: list[Refusal] = []
    for name, switch in section.switches.items():
        sentence = _switch(made, name, switch, facts, section)
        if sentence:
            refusals.append(Refusal(name, f"effects.{name}: {sentence}"))
    refused = {refusal.name for refusal in refusals}
    refusals += [one for one in _unmet(made, section.switches) if one.name not in refused]
    if refusals:
        raise OverrideError(refusals)
    return made


def _switch(made: Overridden, name: str, switch: str, facts: Facts, section: CellEffects) -> str:
    """Follow one switch; returns why it cannot be, or nothing."""
    if name not in made.effects and name not in made.shape_pairs:
        hint = nearest(name, [*BY_NAME, *SHAPE_PAIRS])
        return f"no effect or shape pair is called {quoted(name)}{hint}"
    decisions = made.effects if name in made.effects else made.shape_pairs
    if decisions[name].on == (switch == "on"):
        return ""
    reason = decisions[name].reason
    if switch == "on":
        return _force_on(made, decisions, name, facts, section.switches)
    if name in made.shape_pairs:
        return f"{reason} may touch; without it they would pass through each other"
    if name in _LOGS:
        return "a run without its log is no run; leave it on"
    if name == "contact_log":
        return "the sums in /step are those of the contacts that are logged; leave it on"
    if is_law(name):
        chooser = (
            "the numerics choose" if choice(name).section == "numerics" else "the study chooses"
        )
        return f"{chooser} it; write {_choosing(name, facts, on=False)} instead"
    if not section.force:
        return (
            f"the scene requires it: {reason}; add `force: true` beside it to leave it out "
            "all the same"
        )
    decisions[name] = Decision(False, f"forced off, though: {reason}")
    made.forced[name] = "forced off"
    return ""


def _force_on(
    made: Overridden,
    decisions: dict[str, Decision],
    name: str,
    facts: Facts,
    switches: Mapping[str, str],
) -> str:
    """Put an effect or shape pair in, with all that it needs; returns why that cannot be."""
    for need in (name, *needs(name)):
        if not has_law(need, facts):
            which = "it" if need == name else f"it needs {need}, which"
            chosen = _choosing(need, facts, on=True)
            how = f"; write {chosen} to choose it" if chosen else ""
            return f"{which} is another law, no idle effect{how}"
    decisions[name] = Decision(True, f"forced on; not required: {decisions[name].reason}")
    made.forced[name] = "forced on"
    for need in needs(name):
        if not made.effects[need].on and switches.get(need) is None:
            why = f"forced on, needed by {name}; not required: {made.effects[need].reason}"
            made.effects[need] = Decision(True, why)
            made.forced[need] = "forced on"
    return ""


def _unmet(made: Overridden, switches: Mapping[str, str]) -> Iterator[Refusal]:
    """Yield what is switched off although something that is on needs it."""
    for name, switch in switches.items():
        if switch == "off" and name in made.effects:
            needing = [other for other in made.effects if name in needs(other)]
            on = [other for other in needing if made.effects[other].on]
            if on:
                verb, them = ("needs", "that") if len(on) == 1 else ("need", "those")
                yield Refusal(
                    name,
                    f"effects.{name}: {', '.join(on)} {verb} it; switch {them} off as well",
                )


def _choosing(name: str, facts: Facts, on: bool) -> str:
    """Return what a config must specify for an effect to be on or off.

    Nothing where that key alone does not do it.
    """
    key, section, examples = choice(name)
    annotation: Any = SECTIONS[section].model_fields[key].annotation
    named = (False, True) if annotation is bool else get_args(annotation)
    for value in examples or named:
        if BY_NAME[name].decide(facts._replace(**BUSY, **{key: value})).on == on:
            written = "null" if value is None else value
            written = str(value).lower() if isinstance(value, bool) else written
            return f"`{section}: {{{key}: {written}}}`"
    return ""
