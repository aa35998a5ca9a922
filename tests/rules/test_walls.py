"""The walls between the rooms: data goes one way, and each library has one room that knows it."""

from __future__ import annotations

import ast
import sys
from graphlib import TopologicalSorter

import pytest
from sources import PACKAGES, ROOT, Import, files, imports, module_of, modules, room_of

# What each room may import of ours; itself always. `runner` alone sees the whole line.
ROOMS = {
    "__init__": {"experiment", "runner", "simulator", "trace"},  # public names, imported when used
    "errors": set(),
    "clock": set(),
    "config_options": set(),
    "record_tables": set(),
    "durable_files": set(),
    "garbage": set(),
    "arrow": {"errors", "durable_files"},
    "geometry": {"quantities", "cell"},
    "quantities": {"errors", "clock"},
    "cell": {"errors", "clock", "quantities", "engine"},  # of the engine: DECLARATIONS
    "experiment": {
        *("errors", "clock", "geometry", "quantities", "cell", "engine", "measures", "figures"),
        *("config_options", "garbage", "peers"),
    },
    # of the engine: DECLARATIONS; of declarations alone experiment, measures and cli know
    "peers": {"errors", "geometry", "quantities", "cell", "engine"},
    "engine": {"quantities", "record_tables", "durable_files", "garbage"},
    "scene": {"errors", "clock", "geometry", "quantities", "cell", "experiment", "engine"},
    "trace": {
        *("errors", "clock", "record_tables", "durable_files", "geometry", "quantities", "cell"),
        *("engine", "arrow"),
    },
    "problems": {"errors", "quantities", "engine"},
    "measures": {"errors", "clock", "geometry", "quantities", "cell", "engine", "trace", "peers"},
    "laws": {
        *("errors", "clock", "geometry", "quantities", "cell", "experiment", "engine", "scene"),
        *("trace", "problems"),
    },
    "figures": {
        *("errors", "durable_files", "geometry", "quantities", "cell", "trace", "measures"),
    },
    "replay": {
        *("errors", "durable_files", "geometry", "quantities", "cell", "trace", "measures"),
    },
    "simulator": {
        *("errors", "geometry", "quantities", "cell", "experiment", "scene", "engine"),
    },
    "lint": {"errors", "geometry", "quantities", "cell", "experiment", "engine", "measures"},
    "runner": {
        "lint",
        *("errors", "clock", "quantities", "cell", "experiment", "scene", "engine", "problems"),
        *("trace", "measures", "geometry", "record_tables", "durable_files", "arrow"),
        *("figures", "config_options", "garbage", "peers"),  # figures: a run in a notebook
    },
    "comparison": {"errors", "geometry", "trace", "measures", "runner"},
    "pytest_plugin": {"errors", "experiment", "lint", "trace", "measures", "runner"},
    "cli": {
        *("errors", "quantities", "experiment", "scene", "trace", "measures", "figures"),
        *("replay", "runner", "problems", "comparison", "laws", "peers"),
    },
}
# Modules of the engine that list what it has, without numba: what configs may name.
DECLARATIONS = {"lavendersim.engine.effects", "lavendersim.engine.solvers"}
# A log that is written is laid out by kernels; who reads one loads none.
OF_THE_WRITER = {
    ("lavendersim/trace/message_form.py", "lavendersim.engine.message_kernel"),
    ("lavendersim/trace/contact_columns.py", "lavendersim.engine.difference_kernel"),
    ("lavendersim/trace/predictors.py", "lavendersim.engine.expected_kernel"),
    ("lavendersim/trace/sphere_contacts.py", "lavendersim.engine.expected_kernel"),
    ("lavendersim/trace/points.py", "lavendersim.engine.point_kernel"),
}
# Who may import a library of others; what is not listed is imported by nobody.
LIBRARIES = {
    "numba": {"engine"},
    "llvmlite": {"engine"},
    "numpy": {
        *("scene", "engine", "trace", "measures", "figures", "replay", "simulator", "runner"),
        *("problems", "clock", "geometry", "record_tables", "arrow", "comparison"),
        *("lint", "laws", "peers"),
    },
    "scipy": {"geometry", "problems"},  # hulls, where a scene has one; sparse matrices
    "h5py": {"problems"},
    "pyarrow": {"arrow"},
    **{library: {"runner"} for library in ("dask", "distributed", "dask_jobqueue")},
    "mcap": {"trace"},
    "google": {"trace"},  # google.protobuf
    "zstandard": {"trace"},
    "zlib_ng": {"trace"},
    "rerun": {"replay"},
    "matplotlib": {"figures"},
    "jinja2": {"figures"},
    "pydantic": {"quantities", "engine", "cell", "measures", "figures", "experiment"},
    "pydantic_core": {"quantities", "cell", "measures", "experiment"},
    "yaml": {"experiment", "trace"},
    "typer": {"cli"},
    "rich": {"cli"},
    "pytest": {"pytest_plugin"},
    "gymnasium": {"simulator"},
    **{
        library: {"peers"}
        for library in ("mujoco", "pybullet", "rapier3d", "sapien", "dartpy", "pydrake")
    },
}


def of_others(found: Import) -> bool:
    """Whether an import is of a library that neither we nor Python bring."""
    top = found.module.split(".")[0]
    return top not in sys.stdlib_module_names and top not in PACKAGES.values()


def test_every_room_is_known() -> None:
    assert {room_of(file) for file in files()} == set(ROOMS)


@pytest.mark.parametrize("room", ROOMS)
def test_a_room_imports_only_the_rooms_it_may(room: str) -> None:
    allowed = {*ROOMS[room], room, "__version__"}
    strangers = [
        str(found)
        for found in imports()
        if found.room == room
        and found.module.split(".")[0] in PACKAGES.values()
        and found.target not in allowed
    ]
    assert strangers == []


def test_configs_are_read_with_no_more_of_the_engine_than_its_lists() -> None:
    rooms = ("cell", "experiment", "lint", "measures", "peers", "trace")
    of_engine = [f for f in imports() if f.room in rooms and f.target == "engine"]
    strangers = [
        str(f)
        for f in of_engine
        if f.module.rpartition(".")[0] not in DECLARATIONS
        and (str(f.file), f.module.rpartition(".")[0]) not in OF_THE_WRITER
    ]
    assert strangers == []


@pytest.mark.parametrize("library", LIBRARIES)
def test_a_library_is_known_to_its_rooms_only(library: str) -> None:
    strangers = [
        str(found)
        for found in imports()
        if found.target == library and found.room not in LIBRARIES[library]
    ]
    assert strangers == []


def test_of_the_engine_only_keys_of_effects_know_quantities() -> None:
    files = {str(f.file) for f in imports() if f.room == "engine" and f.target == "quantities"}
    assert all(file.startswith("lavendersim/engine/effects/") for file in files)


def test_one_file_knows_the_format_of_fclib() -> None:
    """h5py is an extra: without it every other file must still work."""
    files = {str(found.file) for found in imports() if found.target == "h5py"}
    assert files == {"lavendersim/problems/fclib.py"}


def test_one_file_knows_dask() -> None:
    names = {"dask", "distributed", "dask_jobqueue"}
    files = {str(found.file) for found in imports() if found.target in names}
    assert files == {"lavendersim/runner/dask_cluster.py"}


def test_no_other_library_is_imported() -> None:
    unknown = [str(f) for f in imports() if of_others(f) and f.target not in LIBRARIES]
    assert unknown == []


def test_the_rooms_form_no_circle() -> None:
    graph: dict[str, set[str]] = {room: set() for room in ROOMS if room != "__init__"}
    for found in imports():
        if found.room in graph and found.target in graph and found.target != found.room:
            graph[found.room].add(found.target)
    order = list(TopologicalSorter(graph).static_order())  # raises CycleError
    assert order.index("measures") < order.index("figures") < order.index("experiment")
    assert order.index("engine") < order.index("scene") < order.index("runner")


FILE_CALLS = {"open", "read_text", "read_bytes", "write_text", "write_bytes", "mkdir", "unlink"}


def test_the_command_line_reads_and_writes_no_files() -> None:
    calls = []
    for file in (ROOT / "cli").rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.Call):
                name = getattr(node.func, "attr", getattr(node.func, "id", ""))
                if name in FILE_CALLS:
                    calls.append(f"{file.name}:{node.lineno} calls {name}")
    assert calls == []


# Who writes files past `durable_files`, and why.
BESIDE_THE_DOOR = {
    "lavendersim/replay/film.py": "frames of a film, in a folder of their own until all are there",
    "lavendersim/trace/container.py": "logs grow for hours, and are readable after a kill",
    "lavendersim/runner/run_index.py": "a line for each cell that ends",
    "lavendersim/runner/run_lock.py": "opens a folder to lock it, writes nothing",
    "lavendersim/engine/compile_lock.py": "an empty file to lock, which stays",
    "lavendersim/runner/unread_output.py": "opens the system's nowhere",
    "lavendersim/runner/leases.py": "what it makes has to fail where it is there",
    "lavendersim/runner/experiment_run.py": "a large table, aside by the door",
    "lavendersim/replay/headless.py": "what the viewer says, gone with it",
    "lavendersim/scene/effects_page.py": "a document",
}


def writes(call: ast.Call) -> bool:
    """Whether a call writes a file: by its name, or opens one with such a mode or flag."""
    name = getattr(call.func, "attr", getattr(call.func, "id", ""))
    if name != "open":
        return name in ("write_text", "write_bytes", "mkstemp", "NamedTemporaryFile")
    modes = [arg.value for arg in call.args if isinstance(arg, ast.Constant)]
    of_the_system = getattr(getattr(call.func, "value", None), "id", "") == "os"
    return of_the_system or any(isinstance(mode, str) and set(mode) & set("wax+") for mode in modes)


def test_files_are_written_through_one_door() -> None:
    found = {
        str(file.relative_to(ROOT))
        for file in (ROOT / "lavendersim").rglob("*.py")
        for node in ast.walk(ast.parse(file.read_text()))
        if isinstance(node, ast.Call) and writes(node)
    }
    assert found == {"lavendersim/durable_files.py", *BESIDE_THE_DOOR}


def test_relative_imports_are_resolved_to_full_names() -> None:
    """The reader of imports itself, on the forms the sources use."""
    statements = "from . import a\nfrom .b import c\nfrom ..d import e\nimport numba.core as n\n"
    package = ["lavendersim", "engine", "effects"]
    found = [m for node in ast.parse(statements).body for m in modules(node, package)]
    assert found == [
        "lavendersim.engine.effects.a",
        "lavendersim.engine.effects.b.c",
        "lavendersim.engine.d.e",
        "numba.core",
    ]
    here = ROOT / "lavendersim/engine/step.py"
    assert (module_of(here), room_of(here)) == (["lavendersim", "engine", "step"], "engine")
