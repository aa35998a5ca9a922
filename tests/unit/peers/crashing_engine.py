"""A process of an engine that goes wrong, by the name of the engine it is asked for."""

from __future__ import annotations

import os
import pickle
import signal
import sys
import time

if __name__ == "__main__":
    how = pickle.load(sys.stdin.buffer).engine
    if how == "crash":
        os.kill(os.getpid(), signal.SIGSEGV)
    if how == "exit":
        print("it is out of memory", file=sys.stderr)
        os._exit(3)
    if how == "write":
        with open("ENGINE_LOG.TXT", "w") as file:
            file.write("what an engine leaves where it works")
        os._exit(3)
    while how == "compute":
        pass
    time.sleep(60)
