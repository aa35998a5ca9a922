"""The benchmark of second order times four laws of a scene, and compares them in one round."""

from __future__ import annotations

from tests.benchmarks import order


def test_every_scene_is_timed_under_every_law() -> None:
    found = order.measure(1, ("cost/drop",))  # engines of one ball compile soonest
    (row,) = found["rows"]
    assert set(row["samples"]) == set(order.LAWS)
    assert all(time > 0.0 for (time,) in row["samples"].values())
    assert row["ratios"]["first order"] == 1.0
    assert order.table(found).count("\n") == 1


def test_laws_are_those_of_the_plans() -> None:
    second = {"impact_order", "contact_midpoint"}
    first_order = order.under("scenes/rest", order.LAWS["first order"])
    assert not second & set(first_order.plan.spec.effects)
    default = order.under("scenes/rest", order.LAWS["default"])
    assert second <= set(default.plan.spec.effects)
    specs = {order.under("scenes/rest", laws).plan.spec for laws in order.LAWS.values()}
    assert len(specs) == len(order.LAWS)  # each law is another engine
