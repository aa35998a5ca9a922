"""States that make events happen, as the engine has them."""

from __future__ import annotations

from laboratory import config, plane, resolved, sphere

from lavendersim.cell.triggers import CONDITIONS
from lavendersim.engine.effects import triggers
from lavendersim.engine.spec import Spec
from lavendersim.scene.trigger_table import trigger_table

SPEC = Spec(effects=("step_log", "triggers"), shape_pairs=())


def test_conditions_have_the_numbers_of_the_engine() -> None:
    assert triggers.CONDITIONS == CONDITIONS
    for number, name in enumerate(CONDITIONS):
        assert getattr(triggers, name.upper()) == number


def test_a_record_has_its_bodies_by_their_rows() -> None:
    cell = resolved(
        {"floor": plane(), "one": sphere(0.1, (0, 0, 1)), "other": sphere(0.1, (1, 0, 1))}
    )
    jump = {
        "at": 0.0, "body": "one", "contact_cache": "keep", "remove": True,
        **dict.fromkeys(("scale_mass", "teleport", "velocity", "angular_velocity")),
    }  # fmt: skip
    cell["triggered"] = [
        {"when": {"condition": "leaves", "bodies": ["other", "floor"]}, "event": jump},
        {
            "when": {"condition": "below", "bodies": ["one"], "along": [0, 0.6, 0.8], "value": 2.0},
            "event": jump,
        },
    ]
    table = trigger_table(config(cell), SPEC)
    assert table["condition"].tolist() == [triggers.LEAVES, triggers.BELOW]
    assert table[["a", "b"]].tolist() == [(2, 0), (1, 1)]
    assert table[["x", "y", "z", "value"]].tolist()[1] == (0.0, 0.6, 0.8, 2.0)
    assert not table["met"].any()
    assert trigger_table(config(cell), Spec(effects=("step_log",), shape_pairs=())) == ()
