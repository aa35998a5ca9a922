"""Kernels that different processes compiled do not meet in one that loads them.

Of two symbols with one name the first one loaded is used. Names are made of what the code depends
on, never of numbers that a process counts: those would call different kernels alike.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from llvmlite.binding import Linkage
from small_configs import python_forked, write

from lavendersim.engine.compile import Kernel
from lavendersim.engine.step import make_advance
from lavendersim.experiment import load_experiment_text
from lavendersim.scene.build import build
from lavendersim.scene.plan import plan_of

# A heavy ball on light ones: sweeps converge slowly, and Newton's method, whose parts are large
# enough to keep symbols of their own, takes over.
HEAVY = """\
scene:
  surfaces: {{rubber: {{friction: 0.5, {resistance}: 0.001}}}}
  bodies:
    floor: {{shape: {{kind: plane}}, surface: rubber}}
    low: {{shape: {{kind: sphere, radius: 0.1}}, mass: 1.0, surface: rubber, position: [0, 0, 0.1]}}
    mid: {{shape: {{kind: sphere, radius: 0.1}}, mass: 1.0, surface: rubber, position: [0, 0, 0.3]}}
    top:
      shape: {{kind: sphere, radius: 0.1}}
      mass: 1000.0
      surface: rubber
      position: [0, 0, 0.5]
      angular_velocity: [0, 0.1, 5]
duration: 0.2
"""
RESISTANCES = ("torsional_friction", "rolling_friction")
# The chapter's laws leave half of a plan, Newton's method with them. A numba that compiles no parts
# compiles whole kernels, of the default's laws in 80 s each: the chapter's in a fifth, with symbols
# of their own for what several places call.
NEWTON = "numerics: {preset: chapter, timestep: 1/240, solver: adaptive, tolerance: 1.0e-10}\n"
SHORT = "numerics: {preset: chapter, timestep: 1/240}\n" if Kernel is None else NEWTON
# Prints the hashes of the last states of the configs in argv, run in turn in one process.
RUN_ALL = """
import json, sys
from pathlib import Path
import lavendersim
runs = [lavendersim.run(Path(config), root=Path(config).parent / "runs") for config in sys.argv[1:]]
print(json.dumps([int(run.run.cells[0].trace().step["state_hash"][-1]) for run in runs]))
"""


def test_two_plans_compiled_apart_and_loaded_together_give_what_each_gives_alone(
    tmp_path: Path,
) -> None:
    kernels = str(tmp_path / "kernels")

    def hashes(*configs: Path) -> Any:
        return json.loads(python_forked(RUN_ALL, *configs, LAVENDER_CACHE_DIR=kernels))

    configs = [
        write(tmp_path, HEAVY.format(resistance=name) + SHORT, f"{name}.yaml")
        for name in RESISTANCES
    ]
    # Where no kernel is kept, the first of two in a process was compiled and run before the other:
    # as if it were alone.
    apart = configs if Kernel is not None else configs[1:]
    alone = [hashes(config)[0] for config in apart]
    together = hashes(*configs)
    assert together[-len(alone) :] == alone
    assert len(set(together)) == 2


# Kernels of one name that scale by the numbers in argv, each optimised by itself. Prints what each
# makes of 1, and whether its part was there.
SCALE_ALL = """
import json, sys
from lavendersim.engine.compile import inner, separate
from lavendersim.engine.kernel_parts import STORE
from lavendersim.engine.spec import Spec
def make(factor):
    def scaled(x):
        return factor * x
    part = separate(inner(scaled), Spec(shape_pairs=("box_box",)))
    def caller(x):
        return part(x)
    return inner(caller)
found = []
for factor in sys.argv[1:]:
    STORE.begin(anew=False)
    found.append((make(float(factor))(1.0), not STORE.alone))
print(json.dumps(found))
"""


@pytest.mark.skipif(Kernel is None, reason="this numba keeps no parts of kernels")
def test_objects_of_one_name_compiled_apart_are_each_their_own_where_both_are_loaded(
    tmp_path: Path,
) -> None:
    """Of two symbols alike the process would call the first one for both."""

    def scaled(*factors: float) -> Any:
        return json.loads(python_forked(SCALE_ALL, *factors, LAVENDER_CACHE_DIR=str(tmp_path)))

    assert [scaled(2.0), scaled(3.0)] == [[[2.0, False]], [[3.0, False]]]
    assert scaled(2.0, 3.0) == [[2.0, True], [3.0, True]]


def test_no_part_of_a_kernel_is_a_symbol_of_its_object() -> None:
    text = HEAVY.format(resistance=RESISTANCES[0]) + NEWTON
    cell = load_experiment_text(text, "heavy.yaml").cells()[0]
    spec = plan_of(cell.config).spec
    engine = build(cell.config, spec).engine(spec)
    engine._kernel, engine._entry = make_advance(spec), None  # compiled here, not loaded
    engine.advance(0)
    (compiled,) = engine._kernel.overloads.values()
    defined = [f for f in compiled.library._final_module.functions if not f.is_declaration]
    exported = {f.name for f in defined if f.linkage == Linkage.external}
    doors = {compiled.fndesc.llvm_func_name, compiled.fndesc.llvm_cpython_wrapper_name}
    assert exported == doors
    assert len(defined) > len(doors), "some part is large enough to be a function of its own"
