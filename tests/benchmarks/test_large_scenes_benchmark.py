"""The benchmark of large scenes makes the scenes that it names, and says what it counts."""

from __future__ import annotations

import pytest

from tests.benchmarks import large_scenes
from tests.benchmarks.large_scenes import SCENES, Large, measure, solved, spheres, swept
from tests.benchmarks.memory_traffic import memory_bandwidth
from tests.benchmarks.prepared_contacts import pile
from tests.benchmarks.scenes import case


@pytest.mark.parametrize(
    ("name", "bodies"),
    [("pyramid_1275", 1275), ("wall_1000", 1000), ("tower_300", 300), ("spheres_10240", 10240)],
)
def test_scenes_have_as_many_bodies_as_their_names_say(name: str, bodies: int) -> None:
    scene = case(SCENES[name].text, record=False).scene()
    assert int((scene.bodies["inv_m"] > 0.0).sum()) == bodies


def test_heaps_of_spheres_have_supernodes_where_a_config_asks() -> None:
    text = spheres(10, 10)
    left, asked = (
        case(one, record=False).plan.decisions["supernodes"] for one in (text, solved(text))
    )
    assert not left.on
    assert asked.on


def test_a_row_counts_the_steps_that_were_solved() -> None:
    row = measure("few", Large(pile(1), 100), 4)  # a plan that packed_sweeps compiles, too
    assert row["bodies"] == 40
    assert row["solved"] == 4
    assert row["worst_residual"] <= large_scenes.TOLERANCE
    found = {"scenes": [row], "steps": 4, "environment": {"processor": "one", "cores": 1}}
    found["memory_bandwidth"] = 20.0
    table = large_scenes.table(found)
    assert f"{'4/4':>9}".strip() in table
    # a block of 27 numbers of axes and 19 more, two places; of each body a line
    assert row["bytes_per_visit"] == {"rows": 8 * (27 + 19 + 2), "bodies": 2 * 64}
    assert "19.2 ns for its own" in table


def test_memory_gives_what_a_machine_may_have() -> None:
    assert 0.1 < memory_bandwidth() < 2000.0  # [GB/s]


def test_heaps_that_ask_for_many_sweeps_have_them_mixed() -> None:
    text = spheres(10, 10)
    few, many = (
        case(one, record=False).plan.decisions["anderson_acceleration"]
        for one in (text, swept(text))
    )
    assert not few.on
    assert many.on
