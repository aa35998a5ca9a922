"""After an edit of the engine nothing stale is run: bits and machine code are a fresh cache's."""

from __future__ import annotations

from pathlib import Path

import pytest
from engine_edits import differs, edits, files_of_the_scene, prepared, run


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    return prepared(tmp_path_factory.mktemp("package"))


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_an_edited_kernel_is_compiled_anew_and_nothing_old_beside_it(
    package: tuple[Path, Path], tmp_path: Path, seed: int
) -> None:
    copy, kept = package
    (edit,) = edits(files_of_the_scene(copy), 1, seed)
    assert differs(copy, kept, edit, tmp_path) == ""


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
