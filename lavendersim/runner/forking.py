"""Whether this process may be forked: of its threads a forked one has only the one that forked.

A forked process begins with all that is in memory: it imports, reads and loads nothing again, and
is sent nothing. But a lock that another thread has at that moment stays locked in it for ever. This
package's own threads, by their names, are none of that: those of logs wait while no log is open,
and what the one that shows a run locks is taken by nobody else. Beside any other thread, and on
other systems than Linux, processes are spawned.
"""

from __future__ import annotations

import sys
import threading
from typing import Final

OWN: Final = "lavender"  # how the names of this package's threads begin


def may_fork() -> bool:
    """Whether a process that is forked here and now has everything it needs."""
    here = threading.current_thread()
    others = (thread for thread in threading.enumerate() if thread is not here)
    return sys.platform == "linux" and all(thread.name.startswith(OWN) for thread in others)
