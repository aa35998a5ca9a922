"""The picture is drawn by rerun's own viewer, which must have nothing to complain about."""

from __future__ import annotations

import io
import os
import sys

import numpy as np
import psutil
import pytest
from PIL import Image

from lavendersim import replay
from lavendersim.errors import LavenderError, MissingDriverError
from lavendersim.replay import drivers, headless

HAS_DRIVER = sys.platform != "linux" or any(drivers.driver_files(os.environ))
needs_driver = pytest.mark.skipif(
    not HAS_DRIVER, reason="no Vulkan driver here (Debian, Ubuntu: mesa-vulkan-drivers)"
)


@pytest.fixture
def others() -> list[psutil.Process]:
    """The processes that run already: other tests' worker pools leave some."""
    return psutil.Process().children(recursive=True)


@needs_driver
def test_viewer_shows_the_trace_without_a_complaint(two_bodies, tmp_path, others):
    picture = tmp_path / "pictures" / "trace.png"
    assert replay.screenshot(two_bodies, picture) == []
    pixels = np.asarray(Image.open(io.BytesIO(picture.read_bytes())).convert("RGB")).astype(int)
    assert pixels.shape == (1000, 1600, 3)
    red, green, blue = np.moveaxis(pixels, -1, 0)
    scene, plots = np.s_[:, :950], np.s_[:, 970:]
    yellow = (red > 180) & (green > 160) & (blue < 120)
    sky_blue = (blue > 180) & (green > 130) & (red < 120)
    assert yellow[scene].sum() > 1000  # force arrows
    assert sky_blue[scene].sum() > 500  # the ball
    assert yellow[plots].sum() > 300  # curve of the force
    assert sky_blue[plots].sum() > 300  # curve of the penetration
    assert psutil.Process().children(recursive=True) == others
    assert list(picture.parent.iterdir()) == [picture]


@needs_driver
def test_what_the_viewer_cannot_show_is_reported(two_bodies, tmp_path, monkeypatch):
    """The check above is worth something only if a defect is heard of."""
    from lavendersim.replay import columns

    draw = headless.write_rrd

    def with_lost_frame(trace, path, title, viewpoint):
        monkeypatch.setattr(columns, "WORLD", "nowhere")
        draw(trace, path, title, viewpoint)

    monkeypatch.setattr(headless, "write_rrd", with_lost_frame)
    monkeypatch.setattr(headless, "NOTICE_SECONDS", 0.0)
    assert replay.screenshot(two_bodies, tmp_path / "trace.png") != []


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux finds drivers by manifests")
def test_missing_driver_is_one_sentence_that_names_the_package(two_bodies, tmp_path, monkeypatch):
    monkeypatch.setenv("VK_DRIVER_FILES", str(tmp_path / "no_such_icd.json"))
    with pytest.raises(MissingDriverError) as caught:
        replay.screenshot(two_bodies, tmp_path / "trace.png")
    assert "mesa-vulkan-drivers" in str(caught.value)
    assert "\n" not in str(caught.value)
    assert not (tmp_path / "trace.png").exists()


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux finds drivers by manifests")
def test_driver_that_does_not_load_is_distinguished_from_the_viewers_own_failure(
    two_bodies, tmp_path, monkeypatch, others
):
    """A manifest may be there and its library not: then only the viewer finds out."""
    manifest = tmp_path / "broken_icd.json"
    manifest.write_text('{"file_format_version": "1.0.0", "ICD": {"library_path": "/none.so"}}')
    monkeypatch.setenv("VK_DRIVER_FILES", str(manifest))
    monkeypatch.setenv("VK_ICD_FILENAMES", str(manifest))
    with pytest.raises(MissingDriverError, match="mesa-vulkan-drivers"):
        replay.screenshot(two_bodies, tmp_path / "trace.png")
    assert psutil.Process().children(recursive=True) == others


def test_viewer_that_never_answers_is_ended(two_bodies, tmp_path, monkeypatch, others):
    sleeper = tmp_path / "sleeper"
    sleeper.write_text("#!/bin/sh\nexec sleep 60\n")
    sleeper.chmod(0o755)
    monkeypatch.setattr(headless, "require_vulkan", lambda: None)
    monkeypatch.setattr(headless, "viewer_program", lambda: sleeper)
    monkeypatch.setattr(headless, "START_SECONDS", 0.5)
    with pytest.raises(LavenderError, match=r"did not load the recording within"):
        replay.screenshot(two_bodies, tmp_path / "trace.png")
    assert psutil.Process().children(recursive=True) == others
