"""The process of an engine from outside: starts it, yields its messages, sees it crash or hang.

A step that computes for too long is another end than one that waits for what never comes.
"""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import time
from collections.abc import Generator
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from tempfile import TemporaryDirectory, TemporaryFile
from typing import IO, Any, Final

from lavendersim.peers.messages import Built, Ended, States, Task

SILENCE: Final = 60.0  # [s] without a word, of the processor where it computes
IDLE: Final = 0.01  # of the processor: it waits, for what does not come
MODULE: Final = "lavendersim.peers.child"
# One thread, whatever an engine would take.
THREADS: Final = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}


def start(
    module: str, number: int, folder: str, given: int, said: int | IO[bytes]
) -> subprocess.Popen[bytes]:
    """Start the process of an engine, which imports what this one would.

    number: the file descriptor that it talks by; given, said: its input, and where errors go.
    folder: where it works, for engines leave files (MuJoCo's MUJOCO_LOG.TXT).
    """
    path = os.pathsep.join(os.path.abspath(place) for place in sys.path)
    return subprocess.Popen(
        [sys.executable, "-P", "-m", module, str(number)],  # -P: nothing from where it works
        stdin=given,
        stdout=subprocess.DEVNULL,
        stderr=said,
        pass_fds=(number,),
        start_new_session=True,  # Ctrl-C is for the run, which ends it and its copies as a group
        env=os.environ | THREADS | {"PYTHONPATH": path},
        cwd=folder,
    )


def messages_of(
    task: Task, silence: float = SILENCE, module: str = MODULE
) -> Generator[Built | States | Ended, None, None]:
    """Yield what a run on an engine sends; the last is `Ended`, also of one that died or hung.

    silence: [s] after which it is ended. Whoever stops asking ends it.
    """
    receiver, sender = Pipe(duplex=False)
    with TemporaryFile() as output, TemporaryDirectory() as folder:
        process = start(module, sender.fileno(), folder, subprocess.PIPE, output)
        sender.close()
        try:
            assert process.stdin is not None
            try:
                process.stdin.write(pickle.dumps(task))
                process.stdin.close()
            except BrokenPipeError:
                pass  # it died before: its end says so
            while True:
                if why := _unanswered(receiver, process.pid, silence):
                    yield Ended(why)
                    return
                try:
                    message: Any = receiver.recv()
                except (EOFError, OSError):
                    yield Ended(_death(process.wait(), output))
                    return
                yield message
                if isinstance(message, Ended):
                    return
        finally:
            process.kill()
            process.wait()
            receiver.close()


def _unanswered(receiver: Connection, pid: int, silence: float) -> str:
    """Wait for a message; returns why there will be none, empty once it is there.

    Of an engine that computes the processor's seconds count, so that other work on the machine ends
    none.
    """
    began = last = _computed(pid)
    while not receiver.poll(silence):
        now = _computed(pid)
        if now - began >= silence:
            return f"takes too long: no step was done in {silence:g} s of the processor"
        if not now - last > IDLE * silence:
            return f"hangs: no step was done in {silence:g} s"
        last = now
    return ""


def _computed(pid: int) -> float:
    """Return how much of the processor a process has had [s]; NaN where nobody says."""
    if not sys.platform.startswith("linux"):
        return float("nan")
    try:
        return time.clock_gettime((~pid << 3) | 2)  # clock_getcpuclockid(3)
    except OSError:  # it has ended
        return float("nan")


def _death(code: int, output: IO[bytes]) -> str:
    """Return how a process died, with the last line that it wrote."""
    how = f"was ended by {signal.Signals(-code).name}" if code < 0 else f"exited with {code}"
    output.seek(0)
    lines = output.read().decode(errors="replace").strip().splitlines()
    return f"crashed: its process {how}{f' ({lines[-1].strip()})' if lines else ''}"
