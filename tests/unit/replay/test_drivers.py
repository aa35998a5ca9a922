"""How a driver or a display is looked for, before anything is started."""

from __future__ import annotations

import sys

import pytest

from lavendersim import replay
from lavendersim.errors import MissingDriverError
from lavendersim.replay import drivers

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="Linux's places and variables")


@pytest.fixture
def manifest(tmp_path):
    folder = tmp_path / "share" / "vulkan" / "icd.d"
    folder.mkdir(parents=True)
    (folder / "lvp_icd.x86_64.json").write_text("{}")
    return folder / "lvp_icd.x86_64.json"


def test_manifests_are_found_in_the_data_directories(manifest, tmp_path):
    environment = {"XDG_DATA_DIRS": f"/nowhere:{tmp_path / 'share'}"}
    assert manifest in drivers.driver_files(environment)


@pytest.mark.parametrize("variable", ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"])
def test_variable_replaces_the_search(manifest, tmp_path, variable):
    searched = {"XDG_DATA_DIRS": str(tmp_path / "share")}
    assert list(drivers.driver_files({**searched, variable: "/no/such.json"})) == []
    assert list(drivers.driver_files({variable: f"/no/such.json:{manifest}"})) == [manifest]
    assert list(drivers.driver_files({variable: str(manifest.parent)})) == [manifest]


def test_window_needs_a_display(one_ball, monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    with pytest.raises(MissingDriverError, match=r"--save FILE\.rrd or --screenshot FILE\.png"):
        replay.open_viewer(one_ball)


def test_viewer_program_is_found_without_a_search_path(monkeypatch):
    monkeypatch.setenv("PATH", "")
    assert drivers.viewer_program().is_file()
