"""Gauss-Seidel sweeps over contacts packed into flat arrays, one or eight at a time."""
