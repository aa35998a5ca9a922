"""One cell that is stepped from Python; `gymnasium_env` alone knows Gymnasium, an extra."""

from lavendersim.simulator.simulator import BODY_CONTACT_COLUMNS, CONTACT_COLUMNS, Simulator

__all__ = ["BODY_CONTACT_COLUMNS", "CONTACT_COLUMNS", "Simulator"]
