"""What stands for what on a page of several engines."""

from __future__ import annotations

from lavendersim.figures.engine_looks import COLOURS, EngineLooks, handles_of
from lavendersim.figures.timestep_errors import least_errors
from tests.made_costs import cost_table, row_data


def peer(engine: str, **more: object) -> dict[str, object]:
    return row_data(solver="", engine=engine, **more)


def test_an_engine_has_one_colour_and_is_hollow_at_its_own_defaults() -> None:
    table = cost_table(
        row_data(role="specified"),
        row_data(sweeps=4),
        peer("mujoco"),
        peer("mujoco-stiff"),
        peer("mujoco", settings={"iterations": 3}),
        *(peer("rapier", settings={"iterations": n}) for n in (1, 4)),  # 4 are its own
        peer("rapier-stiff", settings={"iterations": 4}),
    )
    looks = EngineLooks.of(table.rows)
    _, ours, default, stiff, *_ = table.rows
    assert looks.colour(default) == looks.colour(stiff) == COLOURS["mujoco"].colour
    assert looks.colour(ours) != looks.colour(stiff)
    hollow = [looks.mark(row)["markerfacecolor"] == "white" for row in table.rows]
    assert hollow == [True, False, True, False, False, False, True, False]
    assert len({one.colour for one in COLOURS.values()}) == len(COLOURS)


def test_a_curve_joins_what_differs_in_the_timestep_alone() -> None:
    rows = cost_table(
        *(peer("bullet", settings={"iterations": n}, timestep=h) for n in (5, 50) for h in STEPS),
        peer("rapier", timestep="1/60"),
    ).rows
    curves = list(EngineLooks.of(rows).curves(rows))
    assert sorted(len(curve) for curve in curves) == [1, 2, 2]
    for curve in curves:
        assert [row.timestep for row in curve] == list(STEPS)[: len(curve)]
        assert len({(row.engine, *row.settings.items()) for row in curve}) == 1


STEPS = ("1/60", "1/240")


def test_of_each_engine_and_timestep_the_least_error_is_drawn_whatever_setting_has_it() -> None:
    rows = cost_table(
        peer("bullet", error=0.3, timestep="1/60"),
        peer("bullet-rigid", error=0.1, timestep="1/60", failed="not met: it stands"),
        peer("bullet", error=0.2, timestep="1/240"),
        row_data(error=0.5, timestep="1/60"),
    ).rows
    curves = least_errors(rows)
    assert [[row.error for row in curve] for curve in curves] == [[0.2, 0.1], [0.5]]


def test_panels_name_every_engine_as_its_authors_do_and_the_legend_marks() -> None:
    table = cost_table(row_data(), peer("mujoco", failed="it hangs"), peer("rapier"))
    titles = list(EngineLooks.of(table.rows).members.values())
    assert titles == ["lavender", "MuJoCo", "Rapier"]
    names = [one.get_label() for one in handles_of(table, EngineLooks.of(table.rows))]
    assert names[0] == "1/240 s"
    assert "failed" in names
