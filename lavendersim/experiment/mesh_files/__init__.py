"""Meshes of files: `file: part.obj` of a config becomes the vertices and triangles of that file."""

from __future__ import annotations

from lavendersim.experiment.mesh_files.grafted import refuse_mesh_files, with_mesh_files

__all__ = ["refuse_mesh_files", "with_mesh_files"]
