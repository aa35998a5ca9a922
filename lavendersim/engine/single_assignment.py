"""Variables of a kernel that are assigned more than once, each assignment under its own name.

Numba walks all blocks of a kernel twice for each such variable; here only those that name it. Names
and the order in which they are found are numba's own. Like `part_compiler` this leans on what numba
keeps to itself.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable
from typing import Any, Final

from numba.core import ir, ssa
from numba.core.analysis import compute_cfg_from_blocks
from numba.core.transforms import canonicalize_cfg

from .instruction_variables import variables_of

_ssa: Any = ssa
NEEDED: Final = (
    "_CacheListVars", "_FixSSAVars", "_FreshVarHandler", "_compute_phi_locations",
    "_iterated_domfronts", "_make_states", "_run_ssa",
)  # fmt: skip
if not all(hasattr(ssa, name) for name in NEEDED):
    raise ImportError("numba gives each assignment its name in another way")

Blocks = dict[int, Any]


def run_ssa(blocks: Blocks) -> Blocks:
    """Return blocks in which each variable is assigned once, as numba's `ssa._run_ssa` does."""
    if not blocks:
        return {}
    graph = compute_cfg_from_blocks(blocks)
    named, violators = _look_over(blocks, graph)
    if not violators:
        return blocks
    fronts, listed = _ssa._iterated_domfronts(graph), _ssa._CacheListVars()
    for name in violators:
        labels = [label for label in blocks if label in named[name]]
        assigned: Any = defaultdict(list)
        states = _ssa._make_states(blocks) | {"varname": name, "defmap": assigned}
        blocks = _rewritten(blocks, labels, states, _ssa._FreshVarHandler())
        joined: Any = defaultdict(list)
        states |= {"phimap": joined, "cfg": graph}
        states["phi_locations"] = _ssa._compute_phi_locations(fronts, assigned)
        blocks = _rewritten(blocks, labels, states, _ssa._FixSSAVars(listed))
        for label, joins in joined.items():
            if joins:
                block = blocks[label] = blocks[label].copy()
                block.body = joins + block.body
    return blocks


def _look_over(blocks: Blocks, graph: Any) -> tuple[dict[str, set[int]], list[str]]:
    """Return the blocks that name each variable, and those that are to be renamed, in order.

    They are assigned more than once, or used where their one assignment need not have been.
    """
    named: Any = defaultdict(set)
    uses: Any = defaultdict(set)
    assigned: Any = defaultdict(list)
    for label, block in blocks.items():
        for statement in block.body:
            target = None
            if isinstance(statement, ir.Assign):
                target = statement.target.name
                assigned[target].append(label)
            for variable in statement.list_vars():
                named[variable.name].add(label)
                if variable.name != target:
                    uses[variable.name].add(label)
    violators = {name: None for name, labels in assigned.items() if len(labels) > 1}
    for name, labels in uses.items():
        if name not in violators:
            there = set(assigned.get(name, ()))
            if any(there.isdisjoint(graph.dominators()[each]) for each in labels - there):
                violators[name] = None
    return named, list(violators)


def _rewritten(blocks: Blocks, labels: Iterable[int], states: Any, handler: Any) -> Blocks:
    """Return blocks with the statements of some of them as a handler of numba's gives them."""
    made = dict(blocks)
    for label in labels:
        block = blocks[label]
        states |= {"label": label, "block": block}
        made[label] = ir.Block(scope=block.scope, loc=block.loc)
        made[label].body = [
            handler.on_assign(states, each)
            if isinstance(each, ir.Assign)
            else handler.on_other(states, each)
            for each in block.body
        ]
    return made


def canonical(code: Any) -> Blocks:
    """Return the blocks of a kernel's code, each loop with one way back, as numba has them.

    Numba looks for loops again after each of its passes, most of which leave jumps as they are.
    """
    blocks: Blocks = code.blocks
    jumps = [(label, block.terminator.get_targets()) for label, block in blocks.items()]
    if jumps == getattr(code.func_id, "canonical_jumps", None):
        return blocks
    found: Blocks = canonicalize_cfg(blocks)
    code.func_id.canonical_jumps = jumps if len(found) == len(blocks) else None
    return found


def local_variables(blocks: Blocks) -> set[str]:
    """Return the variables that are assigned once, and used in that block alone, after it.

    They take no room in memory. Numba finds them by what each block defines and uses, which it
    asks of every instruction twice.
    """
    assigned: Counter[str] = Counter()
    carried: set[str] = set()  # used in a block where they are not assigned before
    for block in blocks.values():
        here: set[str] = set()
        for inst in block.body:
            if type(inst) is ir.Assign:
                target = inst.target.name
                carried.update({each.name for each in variables_of(inst.value)} - here)
                assigned[target] += 1
                here.add(target)
            else:
                carried.update({each.name for each in variables_of(inst)} - here)
    return {name for name, times in assigned.items() if times == 1 and name not in carried}
