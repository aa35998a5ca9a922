"""The kinds of measures, by family: one function of a log each, registered with its model."""

from importlib import import_module
from pkgutil import iter_modules


def load_all() -> None:
    """Import every family, so that its functions are registered."""
    for family in iter_modules(__path__):
        import_module(f"{__name__}.{family.name}")
