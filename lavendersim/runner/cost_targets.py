"""The Pareto front of timed settings, and the cheapest setting that reaches each target."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from fractions import Fraction

from lavendersim.errors import UsageError
from lavendersim.measures.cost_table import CostAnswer, CostRow
from lavendersim.peers.catalogue import LAVENDER
from lavendersim.quantities.short_times import short_time

from .step_counts import StepCounts, in_words

ROUND_OFF = 1e-13  # [-] some hundred operations of 2^-52 each; of two such errors none is better


def percentage(text: str) -> float:
    """Return the fraction that a text such as 0.1% stands for; raises UsageError."""
    number = text.strip().removesuffix("%").strip()
    try:
        share = float(number) / 100.0
    except ValueError:
        share = math.nan
    if not text.strip().endswith("%") or not 0.0 < share < math.inf:
        raise UsageError(f'--target: expected a percentage above 0, such as 0.1%, found "{text}"')
    return share


def front_of(rows: Sequence[CostRow]) -> list[int]:
    """Return the settings than which none is cheaper and as good, the cheapest first."""
    errors = {place: max(error_of(row), ROUND_OFF) for place, row in enumerate(rows)}
    good = [place for place, row in enumerate(rows) if row.is_answer]
    good.sort(key=lambda place: (rows[place].cost, errors[place]))
    front: list[int] = []
    for place in good:
        if not front or errors[place] < errors[front[-1]]:
            front.append(place)
    return front


def error_of(row: CostRow) -> float:
    """Return the error of a setting; infinite where it has none."""
    return math.inf if row.error is None else row.error


def answers(rows: Sequence[CostRow], targets: Iterable[float]) -> list[CostAnswer]:
    """Return the cheapest setting of each engine that reaches each target, in words and as a
    fragment.
    """
    engines = dict.fromkeys(row.family for row in rows)
    return [_answer(rows, target, engine) for target in targets for engine in engines]


def across_engines(rows: Sequence[CostRow], found: Sequence[CostAnswer]) -> list[str]:
    """Return a sentence a target, with all engines; none where there is but one.

    0.1 % costs per simulated second: lavender 288 us (..), MuJoCo 19 ms (..), Bullet not reached
    """
    titles = {row.family: row.title for row in rows}
    if len(titles) < 2:
        return []
    sentences = []
    for target in dict.fromkeys(one.target for one in found):
        parts = [_of_engine(rows, one, titles) for one in found if one.target == target]
        sentences.append(f"{percent(target)} costs per simulated second: {', '.join(parts)}")
    return sentences


def _of_engine(rows: Sequence[CostRow], answer: CostAnswer, titles: dict[str, str]) -> str:
    title = titles[answer.engine]
    if answer.row is not None:
        row = rows[answer.row]
        counts = in_words(StepCounts(row.contacts, row.iterations))
        return f"{title} {short_time(row.cost / 1e9)} ({name_of(row)}; {counts})"
    front = front_of_engine(rows, answer.engine)
    nearest = f"at best {percent(error_of(rows[front[-1]]))}" if front else "every setting failed"
    return f"{title} not reached ({nearest})"


def front_of_engine(rows: Sequence[CostRow], engine: str) -> list[int]:
    """Return the front of the settings of one engine."""
    own = [place for place, row in enumerate(rows) if row.family == engine]
    return [own[place] for place in front_of([rows[place] for place in own])]


def _answer(rows: Sequence[CostRow], target: float, engine: str) -> CostAnswer:
    front = front_of_engine(rows, engine)
    reaching = [place for place in front if error_of(rows[place]) <= target]
    if reaching:
        row = rows[reaching[0]]
        sentence = f"{percent(target)} costs {time_of(row)}: {name_of(row)}"
        if alike := _as_cheap(rows, reaching[0], target):
            sentence += f" ({alike} other{'s are' if alike > 1 else ' is'} as cheap, by the spread)"
        return CostAnswer(target, True, reaching[0], sentence, row.fragment, engine)
    of = "the grid" if engine == LAVENDER else engine
    sentence = f"no setting of {of} reaches {percent(target)}"
    if front:
        row = rows[front[-1]]
        nearest = f"{percent(error_of(row))} at {time_of(row)}: {name_of(row)}"
        sentence += f": the nearest is {nearest}"
    else:
        sentence += ": all of them failed"
    return CostAnswer(target, False, None, sentence, None, engine)


def _as_cheap(rows: Sequence[CostRow], best: int, target: float) -> int:
    """Count the other settings that reach a target no slower than the best, within its spread."""
    spread = rows[best].ns_per_second
    assert spread is not None
    own = [row for place, row in enumerate(rows) if place != best]
    others = [row for row in own if row.family == rows[best].family and error_of(row) <= target]
    return sum(
        row.is_answer and row.ns_per_second is not None and row.ns_per_second.low <= spread.high
        for row in others
    )


def percent(share: float) -> str:
    """Return a fraction as people say it: `0.1 %`."""
    return f"{100.0 * share:.3g} %"


def time_of(row: CostRow) -> str:
    """Return the cost of a setting in words."""
    return f"{short_time(row.cost / 1e9)} per simulated second"


def name_of(row: CostRow) -> str:
    """Return a setting in words: `projected_gauss_seidel, 240 Hz, 8 sweeps, warm`."""
    if not row.is_lavender:
        return ", ".join([row.engine, rate_of(row.timestep), *settings_of(row)])
    if row.role == "chapter":
        return f"the chapter's setting ({_knobs(row)})"
    return _knobs(row) if row.preset == "default" else f"{_knobs(row)}, laws of {row.preset}"


def settings_of(row: CostRow) -> list[str]:
    """Return the settings of another engine in words: `iterations 50`."""
    shown = ((k, f"{v:g}" if isinstance(v, float) else v) for k, v in row.settings.items())
    return [f"{key.replace('_', ' ')} {value}" for key, value in shown]


def _knobs(row: CostRow) -> str:
    start = "warm" if row.warm_start else "cold"
    return f"{row.solver}, {steps_of(row)}, {effort_of(row)}, {start}"


def steps_of(row: CostRow) -> str:
    """Return what decides the length of steps: their rate, or the accuracy asked for."""
    if row.accuracy is None:
        return rate_of(row.timestep)
    return f"accuracy {row.accuracy:.0e}".replace("e-0", "e-")


def rate_of(timestep: str) -> str:
    """Return a timestep as its rate: `240 Hz`; as it is where that is no whole number."""
    rate = 1 / Fraction(timestep)
    return f"{rate.numerator} Hz" if rate.denominator == 1 else f"timestep {timestep} s"


def effort_of(row: CostRow) -> str:
    """Return how far a step is solved: its sweeps, or the tolerance that ends them."""
    if row.tolerance is not None:
        return f"to {row.tolerance:.0e} m/s".replace("e-0", "e-")
    return f"{row.sweeps} sweep{'' if row.sweeps == 1 else 's'}"
