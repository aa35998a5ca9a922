"""Contact torque: rows get levers r x n, and their effective mass its rotational part."""

from ..records import LEVER
from .decision import Decision, Facts, named

NAME = "contact_torque"
STAGE = "solve"
CONTACT_FIELDS = LEVER


def wanted(facts: Facts) -> Decision:
    """On when a movable body has a shape whose contact normals may miss its centre of mass."""
    levered = [body.name for body in facts.bodies if body.movable and body.shape == "box"]
    if levered and facts.pairs:
        return Decision(True, f"{named(levered)}: contact normals may miss the centre of mass")
    return Decision(False, "every contact normal passes through the centre of mass it pushes")
