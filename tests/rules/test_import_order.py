"""No import goes round: the modules of every package form no cycle, and each may be the first.

Imports at the top of a file count, and those of `if` and `try` there; a function's are made when it
is called. A module is a node; importing one from outside its package runs that package's
`__init__`, too.
"""

from __future__ import annotations

import ast
import json
import subprocess
import sys
from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter

import pytest
from sources import files, module_of, modules

NAMES = {file: ".".join(module_of(file)).removesuffix(".__init__") for file in files()}
KNOWN = set(NAMES.values())
PACKAGES = {name for file, name in NAMES.items() if file.stem == "__init__"}
# Packages of modules that a list names.
LISTED = {
    *("lavendersim.engine.effects", "lavendersim.engine.solvers"),
    *("lavendersim.measures.kinds", "lavendersim.figures.panels"),
}
# Each module in a process forked from one that has loaded the libraries: nothing of ours is loaded.
# Not those that their package has loaded before them: importing one first is importing the package.
FIRST = """
import gc, json, os, sys
import numba, numba.core.registry, numba.extending, llvmlite.ir, numpy
import matplotlib.pyplot
import pydantic, pydantic.functional_validators, pydantic.json_schema

# Much of pydantic loads with the first model that is made, half of what a fork takes.
pydantic.TypeAdapter(pydantic.create_model("First", number=(int, pydantic.Field(1))))
gc.collect()
gc.freeze()  # no fork looks through what was there before

def loaded_by(name):
    come, go = os.pipe()
    child = os.fork()
    if not child:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
        try:
            __import__(name)
            os.write(go, json.dumps([one for one in sys.modules if one.startswith(name)]).encode())
        except BaseException:
            os._exit(1)
        os._exit(0)
    os.close(go)
    with os.fdopen(come) as said:  # to its end, before it is waited for
        text = said.read()
    return None if os.waitpid(child, 0)[1] else json.loads(text)

refused, first = [], []
for package, names in json.loads(sys.argv[1]).items():
    loaded = loaded_by(package)
    if loaded is None:
        refused.append(package)
    first += sorted({*names} - {*(loaded or ())})
refused += [name for name in first if loaded_by(name) is None]
print(json.dumps([refused, first]))
"""


def at_the_top(node: ast.AST) -> Iterator[ast.AST]:
    """Yield the statements that run when a module is imported; not what only type checkers read."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef):
            continue
        if isinstance(child, ast.If) and "TYPE_CHECKING" in ast.dump(child.test):
            continue
        yield child
        yield from at_the_top(child)


def run_by(importer: str, target: str) -> Iterator[str]:
    """Yield the modules of ours that an import of `target`, a module or a name of one, runs."""
    module = target if target in KNOWN else target.rpartition(".")[0]
    if module in KNOWN:
        yield module
    while module := module.rpartition(".")[0]:
        if module in PACKAGES and not f"{importer}.".startswith(f"{module}."):
            yield module


def imported() -> dict[str, set[str]]:
    """Return what each module imports of ours."""
    graph = {}
    for file, name in NAMES.items():
        nodes = at_the_top(ast.parse(file.read_text()))
        targets = (target for node in nodes for target in modules(node, module_of(file)[:-1]))
        graph[name] = {run for target in targets for run in run_by(name, target)} - {name}
    return graph


def test_no_import_goes_round() -> None:
    graph = imported()
    assert "lavendersim.engine.effects" in graph["lavendersim.engine.step"]  # a package's own
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        pytest.fail(" <- ".join(error.args[1]))


def test_what_a_list_names_can_be_the_first_that_is_imported() -> None:
    """Lists import the modules that they name when they are loaded, which no statement shows."""
    listed = {package: _modules_of(package) for package in sorted(LISTED)}
    assert sum(map(len, listed.values())) > 40
    done = subprocess.run(
        [sys.executable, "-c", FIRST, json.dumps(listed)],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    refused, first = json.loads(done.stdout)
    assert refused == []
    # The list of effects is loaded with its package; solvers, measures and panels when asked for.
    assert {name.rpartition(".")[0] for name in first} >= LISTED - {"lavendersim.engine.effects"}


def _modules_of(package: str) -> list[str]:
    return sorted(name for name in KNOWN if name.rpartition(".")[0] == package)
