"""From numbers to answers: the front, and the sentence of a target."""

from __future__ import annotations

from typing import Any

from lavendersim.measures.cost_table import CostRow
from lavendersim.runner.cost_targets import (
    across_engines,
    answers,
    front_of,
    front_of_engine,
    name_of,
)
from tests.made_costs import cost_table, row_data, spread


def row(cost: float, error: float | None, failed: str = "", **more: Any) -> CostRow:
    """A setting that was timed, within 1 ns."""
    more |= {"ns_per_second": spread(cost, cost - 1.0, cost + 1.0), "error": error}
    given = row_data(fragment=f"numerics: {cost}\n") | more
    return cost_table(given | {"failed": failed}).rows[0]


def test_nothing_on_the_front_failed_or_is_dearer_and_no_better_than_another() -> None:
    rows = [
        row(50.0, 0.2),
        row(10.0, 0.1, failed="diverged"),
        row(20.0, 0.5),
        row(60.0, 0.2),
        row(70.0, 0.01),
        row(15.0, None, failed="its log has no answer"),
        row(20.0, 0.6),
    ]
    assert front_of(rows) == [2, 0, 4]
    two, one = answers(rows, [0.2, 0.001])
    assert two.sentence == (
        "20 % costs 50 ns per simulated second: adaptive, 240 Hz, 8 sweeps, warm"
    )
    assert two.fragment == "numerics: 50.0\n"
    assert one.sentence == (
        "no setting of the grid reaches 0.1 %: the nearest is 1 % at 70 ns per simulated second: "
        "adaptive, 240 Hz, 8 sweeps, warm"
    )


def test_of_two_errors_at_round_off_the_cheaper_is_on_the_front() -> None:
    # 2^-52 = 2.2e-16; both are what some hundred operations leave
    assert front_of([row(50.0, 2e-15), row(20.0, 8e-15), row(10.0, 1e-6)]) == [2, 1]


def test_a_target_is_reached_by_what_is_just_as_good_but_by_no_failure() -> None:
    rows = [row(2e6, 0.01, failed="not met: it stands"), row(3.1e6, 0.01, warm_start=False)]
    (answer,) = answers(rows, [0.01])
    assert answer.row == 1
    assert answer.sentence.startswith("1 % costs 3.1 ms per simulated second: ")
    assert answer.sentence.endswith("8 sweeps, cold")


def test_an_accuracy_answers_a_target() -> None:
    """The cheapest that reaches it, by name and as what is to be pasted."""
    solved = {"tolerance": 1e-9, "timestep": "1/60"}
    rows = [
        row(2e6, 1e-4, accuracy=1e-4, fragment="asked", **solved),
        row(2e6, 1e-2, fragment="equal", **solved),
    ]
    (answer,) = answers(rows, [1e-3])
    assert answer.fragment == "asked"
    assert answer.sentence == (
        "0.1 % costs 2 ms per simulated second: adaptive, accuracy 1e-4, to 1e-9 m/s, warm"
    )


def test_several_engines_answer_a_target_in_one_sentence_each_by_its_own_front() -> None:
    counts = {"contacts": 12.0, "iterations": 2.25}
    rows = [
        row(2e5, 1e-4, contacts=12.0),
        row(1e7, 2e-3, engine="mujoco-stiff", solver="", settings={"iterations": 3}, **counts),
        row(5e5, 0.02, engine="mujoco", solver=""),
        row(1e5, 1e-9, failed="not met: it stands", engine="bullet", solver=""),
    ]
    found = answers(rows, [0.01])
    assert [(one.engine, one.reached) for one in found] == [
        ("lavender", True),
        ("mujoco", True),
        ("bullet", False),
    ]
    assert across_engines(rows, found) == [
        "1 % costs per simulated second: lavender 200 us (adaptive, 240 Hz, 8 sweeps, warm; "
        "12 contacts a step), MuJoCo 10 ms (mujoco-stiff, 240 Hz, iterations 3; 12 contacts, "
        "2.25 iterations a step), "
        "Bullet not reached (every setting failed)"
    ]
    assert front_of_engine(rows, "mujoco") == [2, 1]
    assert across_engines(rows[:1], answers(rows[:1], [0.01])) == []


def test_a_setting_of_another_engine_has_its_numbers_as_people_write_them() -> None:
    settings = {"modulus": 100000000.0, "iterations": 500}
    (row,) = cost_table(row_data(solver="", engine="drake-hydroelastic", settings=settings)).rows
    assert name_of(row) == "drake-hydroelastic, 240 Hz, modulus 1e+08, iterations 500"
