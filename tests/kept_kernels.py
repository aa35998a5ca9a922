"""Kernels that a folder keeps, by what they serve: those of scenes, and those that lay out logs."""

from __future__ import annotations

import shutil
from pathlib import Path

from lavendersim.engine.spec import Spec


def of_scenes(folder: Path) -> list[Path]:
    """Return the files of kernels that step a scene; the others serve logs of every scene."""
    own = Spec().digest()
    return [file for file in folder.glob("*.kernel") if not file.name.startswith(own)]


def parts_of(folder: Path, other: Path) -> None:
    """Make a folder that holds the parts of kernels that another one has, and no whole kernel.

    In it every kernel is compiled, in half of the time that an empty folder takes.
    """
    other.mkdir()
    for file in folder.iterdir():
        if file.suffix in (".part", ".object"):
            shutil.copy(file, other)
