"""The engine's tables of functions of time that act on bodies, filled from a cell."""

from __future__ import annotations

from typing import Any

import numpy as np

from lavendersim.cell import CellConfig
from lavendersim.clock import Clock
from lavendersim.engine.effects import effects_of
from lavendersim.engine.memory import Drives
from lavendersim.engine.record_layout import allocate_drives, allocate_knots
from lavendersim.engine.spec import Spec
from lavendersim.quantities.scalars import exact


def drive_tables(config: CellConfig, spec: Spec, clock: Clock) -> Any:
    """Return the functions of time of a scene; () for an engine without an effect of them."""
    driving = [effect.drives for effect in effects_of(spec) if effect.drives]
    if not driving:
        return ()
    places = {name: row for row, name in enumerate(config.scene.bodies)}
    every = [one for drives in driving for one in drives(config.scene, places)]
    records = allocate_drives(spec, len(every))
    knots = allocate_knots(sum(len(one.terms.knots) for one in every))
    first = 0
    for record, one in zip(records, every, strict=True):
        terms, count = one.terms, len(one.terms.knots)
        knots[first : first + count] = list(terms.knots)
        record["body"], record["first"], record["count"] = one.body, first, count
        record["slope"], record["amplitude"] = terms.slope, terms.amplitude
        record["omega"], record["phase"] = terms.omega, terms.phase
        record["begin_step"], record["end_step"] = 0, np.iinfo(np.int64).max
        if one.begin is not None:
            record["begin_step"] = clock.steps_until(exact(one.begin))
        if one.end is not None:
            record["end_step"] = clock.steps_until(exact(one.end))
        for name, value in one.values.items():
            record[name] = value
        first += count
    return Drives(records, knots)
