"""After an edit of the engine nothing stale is run: bits and machine code are a fresh cache's."""

from __future__ import annotations

from pathlib import Path

import pytest
from engine_edits import differs, edits, files_of_the_scene, prepared, run


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    return prepared(tmp_path_factory.mktemp("package"))


def test_edited_kernels_are_compiled_anew_and_nothing_old_beside_them(
    package: tuple[Path, Path], tmp_path: Path
) -> None:
    """Three edits at once: one of them that is not obeyed shows in the machine code all the same.

    So a cache that has all of them and a fresh one are compiled once, not once for each.
    """
    copy, kept = package
    files = files_of_the_scene(copy)
    drawn = [edit for seed in (1, 2, 3) for edit in edits(files, 1, seed)]
    assert len({edit[:3] for edit in drawn}) == 3
    assert differs(copy, kept, drawn, tmp_path) == ""


def test_an_edit_that_no_kernel_of_the_scene_sees_compiles_nothing(
    package: tuple[Path, Path], tmp_path: Path
) -> None:
    copy, kept = package
    path = copy / "lavendersim/engine/effects/spring.py"
    before = path.read_text()
    edited = before.replace("\ndef make", "\n# a word\n\n\ndef make", 1)
    assert edited != before
    path.write_text(edited)
    try:
        assert run(copy, kept)[1] == {"hits": 1}
    finally:
        path.write_text(before)
