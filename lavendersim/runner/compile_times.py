"""What each engine takes to compile [s]; afterwards its kernel is ready to be called.

The time is one compilation's in a process of its own, since kernels share parts that a process
compiles once; it is the processor's, kept with the kernel, and not taken again.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from time import thread_time
from typing import Final

from lavendersim.cell import CellConfig
from lavendersim.engine.spec import Spec
from lavendersim.engine.step import advance_for, uncompiled
from lavendersim.scene.build import build

from .workers import end_with_parent

PER_ENGINE: Final = 18.0  # [s] of the processor, of boxes by any solver; of a ball 6 s
WORTH_SAYING: Final = 60.0  # [s]


def compiling_ahead(specs: Sequence[Spec]) -> str:
    """Return what compiling the engines will take, in words; "" where that is less than a minute.

    An engine counts that has no kernel yet.
    """
    cold = len(uncompiled(specs))
    seconds = PER_ENGINE * cold
    if seconds < WORTH_SAYING:
        return ""
    return f"{cold} engines are compiled first, once: some {seconds / 60.0:.0f} min of a processor"


def compile_times(
    config: CellConfig,
    specs: Sequence[Spec],
    workers: int,
    progress: Callable[[int, int], None],
) -> dict[Spec, float]:
    """Return the compile time of every spec [s]; what is not known is compiled, `workers` at once.

    progress: called with how many of the missing ones are compiled, and how many were missing.
    """
    times = _known(config, specs)
    missing = [spec for spec in specs if spec not in times]
    if missing:
        progress(0, len(missing))
        # Spawned, never forked; and never a second kernel in a process that has the parts of one.
        with ProcessPoolExecutor(
            min(workers, len(missing)),
            get_context("spawn"),
            initializer=end_with_parent,
            max_tasks_per_child=1,
        ) as pool:
            waiting = {pool.submit(compile_anew, config, spec): spec for spec in missing}
            try:
                for done, future in enumerate(as_completed(waiting), start=1):
                    times[waiting[future]] = future.result()
                    progress(done, len(missing))
            except BaseException:  # Ctrl-C waits for what is being compiled, and for no other
                pool.shutdown(wait=False, cancel_futures=True)
                raise
    return times


def _known(config: CellConfig, specs: Sequence[Spec]) -> dict[Spec, float]:
    """Return the times that are kept with kernels, of those that were compiled alone."""
    cold = set(uncompiled(specs))
    times = {}
    for spec in specs:
        if spec in cold:
            continue
        build(config, spec).engine(spec).advance(0)
        compiled = advance_for(spec)._cache.compiled()
        if compiled is not None and compiled.alone:
            times[spec] = compiled.seconds
    return times


def compile_anew(config: CellConfig, spec: Spec) -> float:
    """Compile the kernel of a spec, whatever is kept of it; returns what it took [s]."""
    cache = advance_for(spec)._cache
    cache.anew = True
    engine = build(config, spec).engine(spec)
    begin = thread_time()
    engine.advance(0)
    spent = thread_time() - begin
    compiled = cache.compiled()  # None where kernels cannot be kept
    return compiled.seconds if compiled is not None else spent
