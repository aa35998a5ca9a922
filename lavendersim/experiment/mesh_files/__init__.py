"""Meshes of files: `file: part.obj` of a config becomes the vertices and triangles of that file."""

from __future__ import annotations

from lavendersim.experiment.mesh_files.grafted import with_mesh_files

__all__ = ["with_mesh_files"]
