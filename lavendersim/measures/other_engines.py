"""What of the checks of every step the log of another engine cannot answer, and why.

A check that takes what an engine does not report is not judged: neither met nor failed.
"""

from __future__ import annotations

from typing import Final

from lavendersim.measures.interfaces import Trace
from lavendersim.measures.overlap_of_bodies import unknown_overlap
from lavendersim.peers.catalogue import peer_of

IMPULSE: Final = "impulse_n"


def unanswered(trace: Trace) -> dict[str, str]:
    """Return the checks that a log cannot answer, with the reason of each; of ours none."""
    engine = trace.config.engine
    if engine is None:
        return {}
    peer = peer_of(engine.name)
    found = {"residual": f"{peer.title} reports no residual of its contacts in m/s"}
    if IMPULSE not in peer.reports(engine.name):
        silent = f"{engine.name} reports no impulses of contacts"
        found |= {"impulses": silent, "momentum": silent}
    elif not peer.momentum:
        found["momentum"] = f"the impulses that {peer.title} reports are not all that acts"
    if why := unknown_overlap(trace.config.scene):
        found["penetration"] = f"{why} from poses alone"
    return found
