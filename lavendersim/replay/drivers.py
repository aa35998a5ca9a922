"""The viewer's program, and whether this machine has a Vulkan driver and a display for it.

The viewer draws with Vulkan. A driver announces itself by a small JSON file that the Vulkan loader
looks for in the directories of the loader's specification; software drivers (lavapipe) too.
Source: Vulkan-Loader, docs/LoaderDriverInterface.md.
"""

from __future__ import annotations

import importlib.util
import os
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

from lavendersim.errors import MissingDriverError

NO_DRIVER = (
    "rerun's viewer needs a Vulkan driver and none was found; install one "
    "(Debian, Ubuntu: apt install mesa-vulkan-drivers, which draws without a graphics card)"
)
NO_DISPLAY = (
    "there is no display to open rerun's viewer on (neither DISPLAY nor WAYLAND_DISPLAY is set); "
    "use --save FILE.rrd or --screenshot FILE.png"
)

# What the viewer of rerun 0.41 says when wgpu found nothing to draw with.
VIEWER_HAS_NO_DRIVER = ("Failed to get render context", "No graphics adapter was found")


def viewer_program() -> Path:
    """Path of the viewer that came with rerun-sdk, found without PATH.

    `.venv/bin/lavender` works in a shell that has not activated the environment; so must this.
    """
    package = importlib.util.find_spec("rerun_cli")
    if package is None or package.origin is None:
        raise MissingDriverError("rerun's viewer is not installed; run: pip install rerun-sdk")
    folder = Path(package.origin).parent
    candidates = (folder / "rerun", folder / "rerun.exe", folder / "Rerun.app/Contents/MacOS/Rerun")
    for program in candidates:
        if program.is_file():
            return program
    raise MissingDriverError(f"rerun's viewer is missing in {folder}; reinstall rerun-sdk")


def require_vulkan(environment: Mapping[str, str] = os.environ) -> None:
    """Raise MissingDriverError where the Vulkan loader will find no driver."""
    if sys.platform == "linux" and not any(driver_files(environment)):
        raise MissingDriverError(NO_DRIVER)


def require_display(environment: Mapping[str, str] = os.environ) -> None:
    """Raise MissingDriverError where no window can be opened."""
    shown = environment.get("DISPLAY") or environment.get("WAYLAND_DISPLAY")
    if sys.platform == "linux" and not shown:
        raise MissingDriverError(NO_DISPLAY)


def driver_files(environment: Mapping[str, str]) -> Iterator[Path]:
    """Every driver manifest the Vulkan loader would consider, in its order."""
    # Either variable replaces the search; the second is the older name of the first.
    for variable in ("VK_DRIVER_FILES", "VK_ICD_FILENAMES"):
        if environment.get(variable):
            yield from _manifests(environment[variable])
            return
    yield from _manifests(environment.get("VK_ADD_DRIVER_FILES", ""))
    for directory in _search_directories(environment):
        yield from sorted((directory / "vulkan" / "icd.d").glob("*.json"))


def _manifests(entries: str) -> Iterator[Path]:
    for entry in filter(None, entries.split(os.pathsep)):
        path = Path(entry)
        if path.is_dir():
            yield from sorted(path.glob("*.json"))
        elif path.is_file():
            yield path


def _search_directories(environment: Mapping[str, str]) -> list[Path]:
    home = environment.get("HOME", "")
    groups = [
        environment.get("XDG_CONFIG_HOME") or (f"{home}/.config" if home else ""),
        environment.get("XDG_CONFIG_DIRS") or "/etc/xdg",
        "/usr/local/etc",
        "/etc",
        environment.get("XDG_DATA_HOME") or (f"{home}/.local/share" if home else ""),
        environment.get("XDG_DATA_DIRS") or "/usr/local/share:/usr/share",
    ]
    return [Path(entry) for group in groups for entry in group.split(os.pathsep) if entry]
