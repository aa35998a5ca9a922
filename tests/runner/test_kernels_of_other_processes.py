"""Kernels that different processes compiled do not meet in one that loads them.

Parts that are the same for every plan have the same symbols, and the first one loaded is used.
Their records differ by plan: numbering types by process would call different records alike.
"""

from __future__ import annotations

import json
from pathlib import Path

from small_configs import python, write

# A heavy ball on light ones: sweeps converge slowly, and Newton's method, whose parts are large
# enough to keep symbols of their own, takes over.
HEAVY = """\
scene:
  surfaces: {{rough: {{friction: 0.5, {resistance}: 0.001}}}}
  bodies:
    floor: {{shape: {{kind: plane}}, surface: rough}}
    low: {{shape: {{kind: sphere, radius: 0.1}}, mass: 1.0, surface: rough, position: [0, 0, 0.1]}}
    mid: {{shape: {{kind: sphere, radius: 0.1}}, mass: 1.0, surface: rough, position: [0, 0, 0.3]}}
    top:
      shape: {{kind: sphere, radius: 0.1}}
      mass: 1000.0
      surface: rough
      position: [0, 0, 0.5]
      angular_velocity: [0, 0.1, 5]
duration: 0.2
"""
RESISTANCES = ("torsional_friction", "rolling_friction")
# Prints the hashes of the last states of the configs in argv, run in turn in one process.
RUN_ALL = """
import json, sys
from pathlib import Path
import lavendersim
runs = [lavendersim.run(Path(config), root=Path(config).parent / "runs") for config in sys.argv[1:]]
print(json.dumps([int(run.run.cells[0].trace().step["state_hash"][-1]) for run in runs]))
"""
# Prints what symbols call two records, the second one of which is made `first` or not.
SYMBOLS = """
import json, sys
import numpy as np
from numba import from_dtype
from numba.core.itanium_mangler import mangle_type_or_value
import lavendersim.engine.compile
made = {}
for field in ("x", "y") if sys.argv[1] == "in order" else ("y", "x"):
    made[field] = mangle_type_or_value(from_dtype(np.dtype([(field, "f8")])))
print(json.dumps([made["x"], made["y"]]))
"""


def test_two_plans_compiled_apart_and_loaded_together_give_what_each_gives_alone(
    tmp_path: Path,
) -> None:
    kernels = str(tmp_path / "kernels")
    configs = [
        write(tmp_path, HEAVY.format(resistance=name), f"{name}.yaml") for name in RESISTANCES
    ]
    alone = [json.loads(python(RUN_ALL, each, LAVENDER_CACHE_DIR=kernels))[0] for each in configs]
    together = json.loads(python(RUN_ALL, *configs, LAVENDER_CACHE_DIR=kernels))
    assert together == alone
    assert len(set(alone)) == 2


def test_a_records_name_in_symbols_tells_its_fields_and_no_order() -> None:
    one, other = json.loads(python(SYMBOLS, "in order")), json.loads(python(SYMBOLS, "reversed"))
    assert one == other
    assert one[0] != one[1]
