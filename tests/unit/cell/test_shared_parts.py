"""What cells of a sweep have in common is kept once: a large sweep fits into memory."""

from __future__ import annotations

import gc
import tracemalloc

from lavendersim.cell.shared_parts import made_once, shared
from lavendersim.cell.surface import Surface
from lavendersim.experiment import load_experiment_text
from lavendersim.runner.cell_jobs import Prepared, prepare
from tests.drop_config import SCENE

FEW, MANY = 100, 400  # cells
# 100,000 cells in 1.5 GB, of which 0.3 GB are the interpreter, numba and the kernels.
MOST_BYTES = 12_000  # of a cell

DROPS = f"""\
{SCENE.replace("numerics: chapter", "numerics: {timestep: 1/240}")}duration: 1.0
sweep:
  mass: {{path: scene.bodies.ball.mass, values: [MASSES]}}
  e: {{path: scene.bodies.ball.surface.restitution, values: [0.1, 0.2, 0.3, 0.4]}}
"""


def prepared(cells: int) -> Prepared:
    masses = ", ".join(f"{0.5 + 0.05 * k:.2f}" for k in range(cells // 4))
    return prepare(load_experiment_text(DROPS.replace("MASSES", masses), "drops.yaml"))


def taken(cells: int) -> tuple[int, int]:
    """Return what preparing so many cells leaves in memory, and what it takes at most [byte]."""
    gc.collect()
    tracemalloc.start()
    try:
        kept = prepared(cells)
        assert len(kept.cells) == cells
        return tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()


def test_a_cell_more_takes_12_kilobytes_at_most() -> None:
    prepared(4)  # what is made once, is made before
    (few, few_peak), (many, many_peak) = taken(FEW), taken(MANY)
    assert (many - few) / (MANY - FEW) <= MOST_BYTES
    assert (many_peak - few_peak) / (MANY - FEW) <= MOST_BYTES


def test_cells_that_differ_in_a_mass_have_the_same_numerics_and_surfaces() -> None:
    one, other = (cell.config for cell in prepared(8).cells[::4])
    assert one.scene.bodies["ball"].mass != other.scene.bodies["ball"].mass
    assert one.numerics is other.numerics
    for part in ("surface", "shape", "release"):
        first, second = (getattr(config.scene.bodies["ball"], part) for config in (one, other))
        assert first is not None
        assert first is second
    assert one.record is other.record
    assert one.study is other.study


def test_which_fields_bodies_were_given_is_kept_once() -> None:
    """Bodies have all of them; a set for each takes 700 bytes."""
    bodies = [body for cell in prepared(8).cells for body in cell.config.scene.bodies.values()]
    assert len({id(body.model_fields_set) for body in bodies}) == 1
    assert bodies[0].model_fields_set == set(type(bodies[0]).model_fields)


def test_parts_that_differ_in_a_bit_are_not_taken_for_equal() -> None:
    plus, minus = (Surface.model_construct(friction=zero) for zero in (0.0, -0.0))
    assert plus == minus
    assert shared(plus) is not shared(minus)
    assert shared(Surface.model_construct(friction=0.0)) is shared(plus)


def doubled(surface: Surface) -> Surface:
    return Surface.model_construct(friction=2.0 * surface.friction)


def halved(surface: Surface) -> Surface:
    return Surface.model_construct(friction=0.5 * surface.friction)


def test_what_is_made_of_equal_parts_is_made_once_and_of_others_by_itself() -> None:
    one, same, other = (Surface.model_construct(friction=mu) for mu in (0.25, 0.25, 0.5))
    assert made_once(one, doubled) is made_once(same, doubled)
    assert made_once(one, doubled).friction == 0.5
    assert made_once(other, doubled).friction == 1.0
    assert made_once(one, halved).friction == 0.125
    zero = made_once(Surface.model_construct(friction=-0.0), doubled)
    assert made_once(Surface.model_construct(friction=0.0), doubled) is not zero
