"""What engines are composed of is kept on disk: whoever knows it from there needs no numba."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from lavendersim.engine import composition, kernel_store
from lavendersim.engine.composition import Composition, composition_of, kept
from lavendersim.engine.solvers.catalogue import SOLVERS
from lavendersim.engine.spec import Spec
from lavendersim.engine.step import kernels_of

PLAIN = Spec(("gravity",), ("sphere_plane",))
FRICTION = PLAIN.including("friction")
SHIPPED = Path(__file__).parents[3] / "configs/chapter/normal_impulse.yaml"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A directory of kernels for this test alone, in a process that knows no composition."""
    monkeypatch.setattr(kernel_store, "directory", lambda: (tmp_path, ""))
    monkeypatch.setattr(composition, "_known", {})
    return tmp_path


def forget(monkeypatch: pytest.MonkeyPatch) -> None:
    """Know nothing, as another process, and be unable to compose anything."""
    monkeypatch.setattr(composition, "_known", {})
    monkeypatch.setattr("lavendersim.engine.step.kernels_of", None)


def test_it_is_what_is_composed_and_what_the_solver_declares(folder: Path) -> None:
    spec = FRICTION._replace(solver="nonsmooth_conjugate_gradient")
    columns = [name for name, _ in SOLVERS[spec.solver].contact_fields]
    assert columns
    assert composition_of(spec) == Composition(kernels_of(spec), columns)


def test_what_was_asked_about_a_plan_is_not_composed_again(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with kept(FRICTION):
        asked = [composition_of(FRICTION), composition_of(PLAIN)]
    assert asked[0] != asked[1]
    forget(monkeypatch)
    with kept(FRICTION):
        assert [composition_of(FRICTION), composition_of(PLAIN)] == asked
    monkeypatch.setattr(composition, "_known", {})
    with pytest.raises(TypeError), kept(PLAIN):  # another plan has another file
        composition_of(PLAIN)


@pytest.mark.parametrize("change", ["sources", "damage"])
def test_what_was_kept_of_other_sources_or_is_damaged_is_not_taken(
    folder: Path, monkeypatch: pytest.MonkeyPatch, change: str
) -> None:
    with kept(FRICTION):
        composition_of(FRICTION)
    (file,) = folder.iterdir()
    if change == "sources":
        monkeypatch.setattr(composition, "source_hash", lambda: "of other sources")
    else:
        file.write_bytes(file.read_bytes()[:-1])
    forget(monkeypatch)
    with pytest.raises(TypeError), kept(FRICTION):
        composition_of(FRICTION)


def test_a_plan_that_was_explained_before_is_explained_without_numba(tmp_path: Path) -> None:
    explain = f"""
import json, sys
from lavendersim.experiment import load_experiment
from lavendersim.runner.log_size import expected_log_sizes
from lavendersim.runner.plans import shared_plans
from lavendersim.scene.explanation import explain_all
experiment = load_experiment({str(SHIPPED)!r})
plans = shared_plans(experiment.cells())
expected_log_sizes(experiment.cells(), plans, experiment.text)
said = json.dumps([one.as_data() for one in explain_all(plans[:1])])
print(json.dumps(["numba" in sys.modules, said]))
"""
    environment = os.environ | {"LAVENDER_CACHE_DIR": str(tmp_path)}
    first, second = (  # by interpreters of their own: one that is forked has numba already
        subprocess.check_output([sys.executable, "-c", explain], env=environment, text=True)
        for _ in range(2)
    )
    assert first.startswith("[true")
    assert second == first.replace("[true", "[false", 1)
