"""The engine's table of states that make events happen, filled from a cell."""

from __future__ import annotations

from typing import Any

from lavendersim.cell import CellConfig
from lavendersim.engine.effects import has_hook
from lavendersim.engine.effects.triggers import CONDITIONS
from lavendersim.engine.record_layout import allocate_triggers
from lavendersim.engine.spec import Spec


def trigger_table(config: CellConfig, spec: Spec) -> Any:
    """Return a record for each trigger of a cell; () for an engine without them.

    An engine that has them may run a cell that has none.
    """
    if not has_hook(spec, "meet_triggers"):
        return ()
    places = {name: row for row, name in enumerate(config.scene.bodies)}
    records = allocate_triggers(len(config.triggered))
    for record, one in zip(records, config.triggered, strict=True):
        when = one.when
        record["condition"] = CONDITIONS.index(when.condition)
        record["a"], record["b"] = places[when.bodies[0]], places[when.bodies[-1]]
        if when.along is not None:
            record["x"], record["y"], record["z"] = when.along
        if when.value is not None:
            record["value"] = when.value
    return records
