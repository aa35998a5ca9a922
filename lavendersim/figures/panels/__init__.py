"""The kinds of panels: a function that draws each, registered with its model."""

from importlib import import_module
from pkgutil import iter_modules


def load_all() -> None:
    """Import every kind, so that its function is registered."""
    for kind in iter_modules(__path__):
        import_module(f"{__name__}.{kind.name}")
