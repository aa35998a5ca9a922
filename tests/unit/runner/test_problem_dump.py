"""`record: {problems: every N}` leaves a run's contact problems as files that others can read."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import lavendersim
from lavendersim.errors import ConfigError
from lavendersim.problems.fclib import read_fclib
from lavendersim.runner import Finished, load_all, problem_dump
from lavendersim.scene.build import build
from lavendersim.scene.plan import plan_of
from tests.runner.small_configs import write

# The ball flies for the first steps, then slides, and pushes the other one along.
PUSH = """\
scene:
  bodies:
    floor: {shape: {kind: plane}, surface: {friction: 0.3, compliance: 1.0e-6}}
    ball:
      shape: {kind: sphere, radius: 0.1}
      mass: 1.0
      surface: {friction: 0.3}
      velocity: [2, 0, 0]
      position: [0, 0, 0.12]
    pushed:
      shape: {kind: sphere, radius: 0.1}
      mass: 2.0
      surface: {friction: 0.3}
      position: [0.3, 0.02, 0.14]
numerics: chapter
duration: 0.25
"""
EVERY, STEPS = 4, 60
ASKED = f"record: {{problems: every {EVERY}}}\n"


@pytest.fixture(scope="module")
def dumped(tmp_path_factory: pytest.TempPathFactory) -> Finished:
    folder = tmp_path_factory.mktemp("dumped")
    return lavendersim.run(write(folder, PUSH + ASKED, "push.yaml"), root=folder / "runs")


def files_of(finished: Finished) -> list[Path]:
    """Return the problems of the only cell, which has its log's name."""
    (cell,) = finished.run.cells
    (folder,) = (finished.run.path / "problems").iterdir()
    assert folder.name == cell.path.stem
    return sorted(folder.iterdir())


def test_every_nth_step_that_has_contacts_has_a_file(dumped: Finished) -> None:
    steps = dumped.run.cells[0].trace().step
    touching = steps["step"][steps["contact_count"] > 0]
    due = [k for k in range(EVERY, STEPS + 1, EVERY) if k in touching]
    assert 0 < len(due) < STEPS // EVERY  # in the first steps nothing touches
    assert [file.name for file in files_of(dumped)] == [f"step_{k:06d}.hdf5" for k in due]


def test_a_file_read_back_is_the_problem_of_its_step(dumped: Finished) -> None:
    cell = dumped.run.experiment.cells()[0].config
    spec = plan_of(cell).spec
    engine, most = build(cell, spec).engine(spec), 0
    for file in files_of(dumped):
        step = int(file.stem.removeprefix("step_"))
        engine.advance(step - int(engine.counters["step"][0]))
        engine.take_rows()
        found = engine.problem()
        assert found is not None
        problem, read = found.problem, read_fclib(file)
        most = max(most, problem.contacts)
        np.testing.assert_array_equal(read.begin, problem.begin)
        np.testing.assert_array_equal(read.row, problem.row)
        np.testing.assert_array_equal(read.mu, problem.mu)
        # softness and target are part of W and of the free velocity there
        softened, free = problem.blocks.copy(), problem.free.copy()
        for c in range(problem.contacts):
            column = np.arange(problem.begin[c], problem.begin[c + 1])
            softened[column[problem.row[column] == c], 0, 0] += problem.gamma[c]
        free[:, 0] += problem.target
        np.testing.assert_array_equal(read.blocks, softened)
        np.testing.assert_array_equal(read.free, free)
        assert (problem.gamma > 0.0).any()
    assert most >= 2


def test_the_guess_in_a_file_is_what_the_log_has_of_the_step(dumped: Finished) -> None:
    h5py = pytest.importorskip("h5py")
    contacts = dumped.run.cells[0].trace().contact
    for file in files_of(dumped):
        logged = contacts[contacts["step"] == int(file.stem.removeprefix("step_"))]
        with h5py.File(file) as opened:
            impulses = opened["guesses/1/r"][:].reshape(-1, 3)
        names = ("impulse_n", "impulse_t1", "impulse_t2")
        np.testing.assert_array_equal(impulses, np.stack([logged[n] for n in names], axis=-1))


def test_asking_changes_nothing_else_in_the_log(dumped: Finished, tmp_path: Path) -> None:
    plain = lavendersim.run(write(tmp_path, PUSH, "push.yaml"), root=tmp_path / "runs")
    one, other = (finished.run.cells[0].trace() for finished in (dumped, plain))
    for table in ("step", "contact", "pose"):
        assert getattr(one, table).tobytes() == getattr(other, table).tobytes()
    assert not (plain.run.path / "problems").exists()


def refused(folder: Path, text: str) -> str:
    config = write(folder, text, "refused.yaml")
    with pytest.raises(ConfigError) as caught:
        load_all([config])
    with pytest.raises(ConfigError):
        lavendersim.run(config, root=folder / "runs")
    assert not (folder / "runs").exists()
    assert caught.value.exit_code == 2
    return str(caught.value).removeprefix(f"{config}:")


def test_without_h5py_nothing_is_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(problem_dump, "find_spec", lambda name: None)
    sentence = "record.problems needs h5py: pip install lavendersim[hdf5]"
    assert refused(tmp_path, PUSH + ASKED).endswith(sentence)


def test_torques_of_contacts_are_refused_at_the_key(tmp_path: Path) -> None:
    line = PUSH.count("\n") + 1
    for name in ("torsional", "rolling"):
        text = PUSH.replace("{friction: 0.3}", f"{{friction: 0.3, {name}_friction: 0.01}}")
        message = refused(tmp_path, text + ASKED)
        assert message.startswith(f"{line}:10: problems: FCLIB files have no {name} friction")
        assert "floor and ball" in message
