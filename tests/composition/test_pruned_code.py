"""Machine code of what a scene does not require is gone: no kernel, no byte, no column of it.

Read are the symbols and the size of the object code that runs (`machine_code`), for each effect in
an engine of a scene that does not require it and in the same engine with the effect compiled in.
What is gone from the one is found in the other, so that looking in the wrong place would be seen.
What is given to the compiler is counted too (`live_statements`), before it inlines anything: that
of every effect; machine code is read of SOME, and with `LAVENDER_TEST_EVERYTHING=1` of all. The
engines are then those of `test_idle_effects`; who runs both compiles them once.
"""

from __future__ import annotations

from collections import Counter
from functools import cache
from typing import Any

import pytest
from idle import MODULES, closed
from idle_scenes import CASES, SCENES, UNLOGGED
from laboratory import Bench, planned
from live_statements import live_statements
from machine_code import Code, code_of

from lavendersim.engine.effects import EFFECTS
from lavendersim.engine.spec import Spec
from lavendersim.engine.step import advance_for, kernels_of
from tests.thorough import THOROUGH

# Effects that have no kernel in their own file: they widen others, or theirs stand elsewhere.
NO_KERNEL = {
    *("broad_phase", "contact_torque", "frictionless_contact", "kinematic", "midpoint", "newton"),
    *("hertz_contact", "joint_stop", "overlooked_points", "packed_sweeps"),
    *("anderson_acceleration", "supernodes", "periodic_boundary"),
}
# Whose code is more or less by what the compiler inlines: a body that is called from one place is
# copied there, the same body beside another (`frictionless_contact`) is called. A condition more
# (`kinematic`, `capture_in_sweeps`) is some 50 bytes, which the layout of a loop may outweigh. So
# are one kernel more behind gravity's and one term more in a row's target: of 27 kB, 50 to 550
# bytes less with them. Without them there is less to compile all the same, and the code is not
# larger by more than a copy or two of a kernel: what an average kernel takes, twice.
INLINED_DIFFERENTLY = {
    *("frictionless_contact", "kinematic", "capture_in_sweeps"),
    *("external_force", "drag", "stabilisation", "compliance", "restitution"),
    *("contact_torque", "falling_restitution"),
}
# Without a pair that may touch there is nothing to compile. Code may be looked at where the effect
# would be another law.
TOUCHING = {
    **{"impact_time": "balls", "speculative": "balls", "contact_spring": "balls"},
    "tangential_compliance": "balls",
}
# Effects that call the kernel.
CALLED_BY = {"pose_log": ("step_log",)}
# A law at contacts, one at impacts and one at the end of a step: some 5 s each to compile. A force
# is looked at instruction by instruction in test_as_if_never_written.
SOME = ("friction", "restitution", "sleeping")
READ = CASES if THOROUGH else SOME
RECORDS = ("body", "velocity", "pair", "contact", "cache", "contact_row", "step_row")


def engines(name: str) -> tuple[dict[str, Any], Spec, Spec]:
    """Return a scene that does not require an effect, and the engine without and with it."""
    cell = SCENES[TOUCHING.get(name, CASES[name][0])]()
    lean = planned(cell, record=name not in UNLOGGED).spec
    return cell, lean, lean.including(*closed(name), *CALLED_BY.get(name, ()))


def code(cell: dict[str, Any], spec: Spec) -> Code:
    """Return what an engine is compiled to."""
    engine = Bench(cell, spec).engine
    engine.advance(1)
    return code_of(engine)


@cache
def statements(spec: Spec) -> dict[tuple[str, str], int]:
    """Return how many statements the kernels of each name hand to the compiler, by module, name."""
    found: Counter[tuple[str, str]] = Counter()
    for kernel, count in live_statements(advance_for(spec)).items():
        function = kernel.py_func
        name = function.__qualname__.rpartition("<locals>.")[2]
        found[function.__module__.partition(".engine.")[2], name] += count
    return found


def columns(cell: dict[str, Any], spec: Spec) -> dict[str, set[str]]:
    """Return the columns of an engine's arrays, by the group of fields that effects bring to them.

    An array without a row, as the cache is where nothing is carried over, has no columns.
    """
    engine = Bench(cell, spec).engine
    arrays = engine.state[:5]  # bodies, velocities, pairs, contacts, cache
    return {
        group: set(array.dtype.names or ()) if len(array) else set()
        for group, array in zip(
            RECORDS, (*arrays, engine.log.contact, engine.log.step), strict=True
        )
    }


@pytest.mark.parametrize("name", READ)
def test_no_machine_code_of_an_absent_effect_is_there(name: str) -> None:
    cell, lean, full = engines(name)
    gone, there = code(cell, lean), code(cell, full)
    own = {(f"effects.{name}", kernel) for kernel in kernels_of(full).get(f"effects.{name}", ())}
    assert bool(own) == (name not in NO_KERNEL)
    assert gone.of(name) == set()
    assert {_as_listed(kernel, own) for kernel in there.of(name)} == own
    copies = 2 if name in INLINED_DIFFERENTLY else 0
    assert gone.size < there.size + copies * there.size / len(there.kernels)


@pytest.mark.parametrize("name", CASES)
def test_the_compiler_is_given_no_kernel_of_an_absent_effect_and_less(name: str) -> None:
    """Before anything is inlined; without exception."""
    _, lean, full = engines(name)
    place = f"effects.{name}"
    own = {(place, kernel) for kernel in kernels_of(full).get(place, ())}
    assert bool(own) == (name not in NO_KERNEL)
    gone, there = statements(lean), statements(full)
    assert not {kernel for kernel in gone if kernel[0] == place}
    assert own <= {_as_listed(kernel, own) for kernel in there}
    assert sum(gone.values()) < sum(there.values())


def test_absent_effects_leave_no_kernel_of_theirs_at_all() -> None:
    """A frictionless drop beside the same with every effect there is."""
    cell = SCENES["single ball"]()
    lean = planned(cell).spec
    full = lean.including(*MODULES)
    modules = {module for module, _ in code(cell, lean).kernels if module.startswith("effects.")}
    assert modules <= {f"effects.{name}" for name in lean.effects}
    # Every effect makes the kernels that both have wider, so less is left than the share of their
    # number.
    drop, everything = statements(lean), statements(full)
    assert sum(drop.values()) / sum(everything.values()) < len(drop) / len(everything)


@pytest.mark.parametrize("scene", ["balls", "frictional balls", "boxes"])
def test_the_kernels_that_a_plan_lists_are_those_that_are_compiled(scene: str) -> None:
    cell = SCENES[scene]()
    spec = planned(cell).spec
    listed = {(module, name) for module, names in kernels_of(spec).items() for name in names}
    assert listed == {_as_listed(kernel, listed) for kernel in code(cell, spec).kernels}
    # Beside these the compiler is given kernels that every engine has alike.
    assert listed <= {_as_listed(kernel, listed) for kernel in statements(spec)}


def _as_listed(kernel: tuple[str, str], listed: set[tuple[str, str]]) -> tuple[str, str]:
    """Return a kernel by the name of its function: links of a chain have a symbol each."""
    module, name = kernel
    names = [other for place, other in listed if place == module and name.startswith(f"{other}_")]
    return kernel if kernel in listed or not names else (module, max(names, key=len))


@pytest.mark.parametrize("name", CASES)
def test_records_have_no_column_of_an_absent_effect(name: str) -> None:
    cell, lean, full = engines(name)
    before, after = columns(cell, lean), columns(cell, full)
    for group in RECORDS:
        elsewhere = {
            field
            for effect in EFFECTS
            if lean.has(effect.name)
            for field in effect.columns_by_record().get(group, ())
        }
        own = {*MODULES[name].columns_by_record().get(group, ())} - elsewhere
        assert own & before[group] == set()
        assert before[group] <= after[group]
        if after[group]:
            assert own <= after[group]
