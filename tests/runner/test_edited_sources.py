"""Results follow the sources: an edit of the engine is obeyed, and forgotten with the edit.

One cache directory for all: the kernels of the sources as they are lie beside those of every edit.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from small_configs import copy_package, run_in_new_process, write

from tests.kept_kernels import of_scenes

Found = dict[str, Any]


class Edit(NamedTuple):
    """A line of an engine source, what is put in its place, and what must come of it."""

    source: str
    line: str
    edited: str
    obeyed: Callable[[Found, Found], bool]  # of what was found before and after the edit


EDITS = {
    # falling upwards for 0.5 s from 0.15 m, with 9.8 m/s^2: to 1.4 m
    "an effect": Edit(
        "effects/gravity.py",
        "velocity.vz += params.gz",
        "velocity.vz -= params.gz",
        lambda before, after: min(after["heights"]) > 1.0 > max(before["heights"]),
    ),
    # contacts that never push: the ball sinks into the floor it else stands on, within a slop
    "a solver": Edit(
        "solvers/row_update.py",
        "lambda_new = max(lambda_old - w * contact.inv_k, 0.0)",
        "lambda_new = 0.0 * w",
        lambda before, after: max(after["heights"]) < 0.09 < min(before["heights"]),
    ),
    # a ball of twice its radius: at e = 0.2 it comes to rest one radius higher
    "a shape": Edit(
        "collide/pairs/sphere_plane.py",
        "- plane.offset - r",
        "- plane.offset - 2.0 * r",
        lambda before, after: before["heights"][0] < 0.15 < after["heights"][0],
    ),
    # A constant that kernels of other files hold: bodies touch when they overlap by a metre only,
    # so contacts that carry nothing are not logged.
    "the records": Edit(
        "records.py",
        "TOUCHING: Final = 1e-9",
        "TOUCHING: Final = -1.0",
        lambda before, after: sum(after["contacts"]) < sum(before["contacts"]),
    ),
}


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path, Found]:
    """A config, a cache that holds its kernel, and what the run that filled it gave."""
    folder = tmp_path_factory.mktemp("unedited")
    config, kernels = write(folder), folder / "kernels"
    found = run_in_new_process(config, folder / "runs", LAVENDER_CACHE_DIR=str(kernels))
    assert found["statuses"] == ["complete"] * 3
    return config, kernels, found


@pytest.mark.parametrize("name", EDITS)
def test_an_edit_is_obeyed_and_ends_with_the_edit(
    kept: tuple[Path, Path, Found], tmp_path: Path, name: str
) -> None:
    config, kernels, before = kept
    edit = EDITS[name]
    source = copy_package(tmp_path) / edit.source
    text = source.read_text()
    assert text.count(edit.line) == 1
    source.write_text(text.replace(edit.line, edit.edited))

    def run(root: str) -> Found:
        found = run_in_new_process(
            config,
            tmp_path / root,
            LAVENDER_CACHE_DIR=str(kernels),
            PYTHONPATH=str(tmp_path),
        )
        assert Path(found["package"]).is_relative_to(tmp_path)
        return found

    after = run("edited")
    assert after["source"] != before["source"]
    assert edit.obeyed(before, after), (before, after)
    source.write_text(text)
    held = set(of_scenes(kernels))
    again = run("restored")
    # To the byte, with the kernel that the sources as they are left before the edit.
    assert again["logs"] == before["logs"]
    assert set(of_scenes(kernels)) == held
