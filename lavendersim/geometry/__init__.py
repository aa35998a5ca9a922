"""Rigid-body geometry that several packages need: rotations, hulls, mass properties.

It stands below everything but the typed shapes of a cell. Two kinds of modules:

- plain floats (`vectors`, `quaternions`, `principal_axes`, `convex_hull`, `mass_properties`,
  `support`): what a resolved config is made with, additions, products and square roots in a fixed
  order, so that it has the same digits on every machine, and without numpy, which reading a config
  does not wait for;
- arrays (`rotations`, `shapes`, `bodies`): what scenes, logs, measures and views are made with.

Quaternions are w, x, y, z and take a body's frame to the world's. The kernels of the engine have
their own arithmetic, compiled; slow twins of it for tests stand in `tests/oracle`.
"""
