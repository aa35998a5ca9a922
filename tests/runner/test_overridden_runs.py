"""What is switched by hand is part of what a cell is: of its digest, its log and its engine.

And a union says which of its cells require what.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from small_configs import DROPS, python, write

import lavendersim
from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment_text
from lavendersim.runner import load_all
from lavendersim.runner.cell import plan_in_log
from lavendersim.runner.plans import distinct, shared_plans
from lavendersim.scene.explanation import explain_all
from lavendersim.scene.plan import Plan

ALONE = DROPS[: DROPS.index("sweep:\n")].replace("duration: 0.5", "duration: 0.05")
BY_E = DROPS.replace("[0.2, 0.5, 0.8]", "[0, 0.5, 0.8]")
BY_SWITCH = DROPS.replace(
    "sweep:\n", "sweep:\n  f: {path: effects.restitution, values: [on, off]}\n"
)


def plans(text: str) -> list[Plan]:
    return distinct(shared_plans(load_experiment_text(text, "t.yaml").cells()))


def test_switches_change_the_digest_of_the_same_scene() -> None:
    sections = ["", "effects: {friction: on}\n", "effects: {friction: off}\n"]
    cells = [load_experiment_text(ALONE + more, "t.yaml").cells()[0] for more in sections]
    assert len({cell.digest for cell in cells}) == 3
    for cell in cells:
        assert cell.config.as_dict()["scene"] == cells[0].config.as_dict()["scene"]
    again = load_experiment_text(ALONE + "effects: {drag: off, friction: on}\n", "t.yaml")
    swapped = load_experiment_text(ALONE + "effects: {friction: on, drag: off}\n", "t.yaml")
    assert again.cells()[0].digest == swapped.cells()[0].digest


def test_a_union_says_which_cells_require_what() -> None:
    (plan,) = plans(BY_E)
    assert plan.spec.has("restitution")
    assert [cell.number for cell in plan.required_by["restitution"]] == [1, 2]
    assert plan.requirement("restitution") == "required by 2 of 3 cells: e=0.5; e=0.8"
    assert plan.requirement("gravity") == ""  # all of them do
    assert plan.requirement("friction") == ""  # none does
    (said,) = explain_all([plan])
    by_name = {part.name: part for part in said.effects}
    assert by_name["restitution"].required_by == [1, 2]
    assert list(by_name["restitution"].reasons.values()) == [[1], [2]]
    assert by_name["gravity"].required_by == [0, 1, 2]
    assert by_name["friction"].required_by == []
    logged = plan_in_log(plan).metadata["plan"]["restitution"]
    assert logged.startswith("on: floor and ball: coefficient 0.5")
    assert logged.endswith("required by 2 of 3 cells: e=0.5; e=0.8")


def test_of_many_cells_a_sentence_names_a_few() -> None:
    values = [0, *(round(0.1 + k / 100, 2) for k in range(20))]
    (plan,) = plans(DROPS.replace("[0.2, 0.5, 0.8]", str(values)))
    assert plan.requirement("restitution") == (
        "required by 20 of 21 cells: e=0.1; e=0.11; e=0.12; 17 more"
    )


def test_cells_that_are_switched_differently_share_no_engine() -> None:
    on, off = plans(BY_SWITCH + "effects: {force: true}\n")
    assert (on.spec.has("restitution"), off.spec.has("restitution")) == (True, False)
    assert off.forced == {"restitution": "forced off"}
    assert on.forced == {}  # the scene requires it
    assert [one.title for one in explain_all([on, off])] == [
        "effects: restitution: on (3 cells)",
        "effects: restitution: off (3 cells)",
    ]


def test_in_a_union_what_some_cell_requires_is_not_forced_on() -> None:
    (plan,) = plans(BY_E + "effects: {restitution: on}\n")
    assert plan.forced == {}
    assert plan.decisions["restitution"].reason.startswith("floor and ball: coefficient 0.5")
    (forced,) = plans(BY_E + "effects: {restitution: off, force: true}\n")
    assert forced.forced == {"restitution": "forced off"}
    assert forced.decisions["restitution"].reason.startswith("forced off, though: ")


def test_a_swept_switch_is_refused_at_its_value() -> None:
    with pytest.raises(ConfigError) as caught:
        plans(BY_SWITCH)
    line = BY_SWITCH.splitlines().index("  f: {path: effects.restitution, values: [on, off]}")
    text = BY_SWITCH.splitlines()[line]
    (defect,) = caught.value.defects
    assert (defect.line, defect.column) == (line + 1, text.index("off") + 1)


def test_all_files_of_a_command_are_reported_before_anything_runs(tmp_path: Path) -> None:
    write(tmp_path, ALONE + "effects: {restitution: off}\n", "a.yaml")
    write(tmp_path, ALONE + "effects: {drga: on}\n", "b.yaml")
    write(tmp_path, ALONE + "duratoin: 1\n", "c.yaml")
    write(tmp_path, ALONE, "d.yaml")
    with pytest.raises(ConfigError) as caught:
        load_all([tmp_path])
    files = [Path(defect.file).name for defect in caught.value.defects]
    assert files == ["a.yaml", "b.yaml", "c.yaml"]


def test_a_run_that_is_refused_writes_nothing(tmp_path: Path) -> None:
    config = write(tmp_path, ALONE + "effects: {restitution: off}\n")
    with pytest.raises(ConfigError):
        lavendersim.run(config, root=tmp_path / "runs")
    assert not (tmp_path / "runs").exists()


def test_a_simulator_refuses_at_the_same_place(tmp_path: Path) -> None:
    config = write(tmp_path, ALONE + "effects: {restitution: off}\n")
    with pytest.raises(ConfigError, match=r"drops\.yaml:\d+:11: effects\.restitution: the scene"):
        lavendersim.Simulator(config)


def test_loading_needs_no_numba_whatever_is_switched(tmp_path: Path) -> None:
    """Switches are planned as they are loaded; a plan compiles nothing."""
    code = (
        "import sys; from pathlib import Path; from lavendersim.runner import load_all; "
        "load_all([Path(sys.argv[1])]); print('numba' in sys.modules)"
    )
    assert python(code, write(tmp_path, ALONE, "plain.yaml")) == "False"
    switched = write(tmp_path, ALONE + "effects: {drag: off}\n", "switched.yaml")
    assert python(code, switched) == "False"


def test_logs_say_what_was_forced(tmp_path: Path) -> None:
    """And the same scene, overridden or not, has two logs with the same motion."""
    text = ALONE.replace("restitution: 0.5", "restitution: 0")
    runs = []
    for name, more in (("as_it_is", ""), ("forced", "effects: {restitution: on}\n")):
        config = write(tmp_path, text + more, f"{name}.yaml")
        runs.append(lavendersim.run(config, root=tmp_path / "runs").run.cells[0])
    derived, forced = runs
    assert derived.path.name != forced.path.name
    assert "forced" not in derived.trace().metadata
    assert forced.trace().metadata["forced"] == {"restitution": "forced on"}
    assert forced.trace().metadata["plan"]["restitution"] == (
        "on: forced on; not required: "
        + derived.trace().metadata["plan"]["restitution"].removeprefix("off: ")
    )
    assert forced.trace().metadata["shape pairs"] == {"sphere_plane": "on: floor and ball"}
    # An effect at coefficient zero is idle.
    assert (forced.trace().pose == derived.trace().pose).all()
