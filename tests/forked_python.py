"""Python processes that begin with lavender imported: a server forks one for every command.

A process of its own takes a second of the processor until lavender, numba and scipy are imported,
and the suite starts hundreds. Each one here is forked from a server that has imported them, before
it has run anything; from then on it is what `python FILE`, `-m MODULE` and `-c CODE` are: its own
memory, directory, environment, streams, `__main__` and exit code. What such a start itself does
(imports, their time, interpreters with other paths) is claimed with real processes elsewhere; so
is an environment that modules read as they are imported (see `LATE`).
"""

from __future__ import annotations

import atexit
import gc
import json
import os
import socket
import subprocess
import sys
import tempfile
import threading
import traceback
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

# What is read while a command runs, not while modules are imported: with other variables than the
# server's a process cannot be forked from it.
LATE = ("LAVENDER_CACHE_DIR", "NO_COLOR", "PYTEST_CURRENT_TEST")
ROOT = Path(__file__).parents[1]


def python(
    *arguments: object, where: Path | None = None, **environment: str
) -> subprocess.CompletedProcess[str]:
    """Run `python FILE ...`, `-m MODULE ...` or `-c CODE ...` in a directory, to its end."""
    words, required = [str(each) for each in arguments], os.environ | environment
    place = Path.cwd() if where is None else where
    server = _server(os.getpid())
    if server is None or _early(required) != _early(server.environment):
        return subprocess.run(
            [sys.executable, *words],
            cwd=place, capture_output=True, text=True, env=required, check=False,
        )  # fmt: skip
    return server.run(words, place, required)


def _early(environment: Mapping[str, str]) -> dict[str, str]:
    return {name: value for name, value in environment.items() if name not in LATE}


class _Server:
    """The server of this process: begun with the first command, ended with this process."""

    def __init__(self) -> None:
        self.environment = dict(os.environ)
        self._channel, theirs = socket.socketpair()
        with theirs:
            self._process = subprocess.Popen(
                [sys.executable, "-m", "tests.forked_python", str(theirs.fileno())],
                cwd=ROOT, pass_fds=[theirs.fileno()], stdin=subprocess.DEVNULL,
            )  # fmt: skip
        self._replies = self._channel.makefile()
        atexit.register(self.close)

    def run(
        self, words: Sequence[str], where: Path, environment: Mapping[str, str]
    ) -> subprocess.CompletedProcess[str]:
        with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
            task = {"words": words, "where": str(where), "environment": dict(environment)}
            message = json.dumps(task).encode()
            size = len(message).to_bytes(8, "little")
            socket.send_fds(self._channel, [size], [out.fileno(), err.fileno()])
            self._channel.sendall(message)
            code = int(self._replies.readline())
            out.seek(0)
            err.seek(0)
            streams = out.read().decode(), err.read().decode()
        return subprocess.CompletedProcess([sys.executable, *words], code, *streams)

    def close(self) -> None:
        """End the server, which ends when nobody can ask it any more."""
        self._replies.close()
        self._channel.close()
        self._process.wait()


@cache
def _server(owner: int) -> _Server | None:
    """Return the server of a process; none where processes cannot be forked."""
    return _Server() if hasattr(os, "fork") and hasattr(socket, "send_fds") else None


def _preload() -> None:
    """Import what commands import, and what numba does with the first kernel it loads."""
    import importlib
    import pkgutil

    from numba.core.registry import cpu_target

    import lavender_cli

    for module in pkgutil.iter_modules(lavender_cli.__path__, "lavender_cli."):
        if module.name != "lavender_cli.main":  # `python -m` is to import it as `__main__`
            importlib.import_module(module.name)
    importlib.import_module("rerun")
    for room in ("experiment", "figures", "lint", "measures", "runner", "scene", "trace"):
        package = importlib.import_module(f"lavendersim.{room}")
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            importlib.import_module(module.name)
    cpu_target.typing_context.refresh()
    cpu_target.target_context.refresh()


def _serve(channel: socket.socket) -> dict[str, Any] | None:
    """Fork a process for every task; returns in each of them with its task, and None at the end."""
    while True:
        head, streams, _, _ = socket.recv_fds(channel, 8, 2)
        if not head:
            return None
        length = int.from_bytes(head, "little")
        message = b""
        while len(message) < length:
            message += channel.recv(length - len(message))
        child = os.fork()
        if child == 0:
            channel.close()
            for stream, number in zip(streams, (1, 2), strict=True):
                os.dup2(stream, number)
                os.close(stream)
            return json.loads(message)
        for stream in streams:
            os.close(stream)
        _, status = os.waitpid(child, 0)
        channel.sendall(f"{os.waitstatus_to_exitcode(status)}\n".encode())


def _become(task: dict[str, Any]) -> int:
    """Do what a new interpreter does with these arguments, in this directory and environment.

    Returns its exit code.
    """
    import runpy

    os.environ.clear()
    os.environ.update(task["environment"])
    os.chdir(task["where"])
    first, *rest = task["words"]
    try:
        if first == "-m":
            sys.path[0], sys.argv = task["where"], rest
            runpy.run_module(rest[0], run_name="__main__", alter_sys=True)
        elif first == "-c":
            code, *rest = rest
            sys.path[0], sys.argv = "", ["-c", *rest]
            exec(compile(code, "<string>", "exec"), {"__name__": "__main__"})
        else:
            sys.path[0], sys.argv = str(Path(first).parent), task["words"]
            runpy.run_path(first, run_name="__main__")
    except SystemExit as end:
        if isinstance(end.code, str):
            print(end.code, file=sys.stderr)
        return end.code if isinstance(end.code, int) else int(end.code is not None)
    except BaseException:
        traceback.print_exc()
        return 1
    return 0


def _end(code: int) -> None:
    """End as an interpreter does, but for freeing all modules, which takes half a second."""
    threading._shutdown()  # waits for those that run
    atexit._run_exitfuncs()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)


if __name__ == "__main__":
    _preload()
    gc.collect()
    gc.freeze()  # what is imported is not looked through again, page for page, in every process
    asked = _serve(socket.socket(fileno=int(sys.argv[1])))
    if asked is not None:
        _end(_become(asked))
