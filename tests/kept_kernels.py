"""Kernels that a folder keeps, by what they serve: those of scenes, and those that lay out logs."""

from __future__ import annotations

from pathlib import Path

from lavendersim.engine.spec import Spec


def of_scenes(folder: Path) -> list[Path]:
    """Return the files of kernels that step a scene; the others serve logs of every scene."""
    own = Spec().digest()
    return [file for file in folder.glob("*.kernel") if not file.name.startswith(own)]
