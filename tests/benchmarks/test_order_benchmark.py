"""The benchmark of second order times four laws of a scene, and compares them in one round."""

from __future__ import annotations

from tests.benchmarks import order


def test_every_scene_is_timed_under_every_law() -> None:
    found = order.measure(1, ("scenes/rest",))
    (row,) = found["rows"]
    assert set(row["samples"]) == set(order.LAWS)
    assert all(time > 0.0 for (time,) in row["samples"].values())
    assert row["ratios"]["first order"] == 1.0
    assert order.table(found).count("\n") == 1


def test_laws_are_those_of_the_plans() -> None:
    config = order.config_of("scenes/rest", order.LAWS["first order"])
    effects = order.plan_of(config, record=False).spec.effects
    assert not {"impact_order", "contact_midpoint"} & set(effects)
    default = order.config_of("scenes/rest", order.LAWS["default"])
    effects = order.plan_of(default, record=False).spec.effects
    assert {"impact_order", "contact_midpoint"} <= set(effects)
