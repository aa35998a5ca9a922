"""A film: a frame for every twenty-fifth of a second, joined by ffmpeg or kept as pictures."""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np
import pytest

from lavendersim import replay
from lavendersim.errors import LavenderError, UsageError
from lavendersim.replay import film
from lavendersim.replay.viewpoint import Viewpoint

SECOND = 1_000_000_000

# What ffmpeg gets: the count of its frames and its arguments, or a reason why it makes nothing.
JOINS = """#!{python}
import sys, glob
words = sys.argv[1:]
frames = sorted(glob.glob(words[words.index("-i") + 1].replace("%05d", "*")))
if {fails}:
    sys.exit("no such codec")
open(words[-1], "w").write(f"{{len(frames)}} {{words[words.index('-framerate') + 1]}}")
"""


@pytest.fixture
def shot(monkeypatch) -> list[float]:
    """The moments [s] of which pictures were taken, without a viewer."""
    taken: list[float] = []

    def pictures(trace, title, viewpoint, moments):
        for moment in moments:
            taken.append(int(moment.astype("int64")) * 1e-9)
            yield b"a picture"

    monkeypatch.setattr(film, "pictures", pictures)
    return taken


def ffmpeg(folder: Path, monkeypatch, fails: bool = False) -> None:
    """Put a program of that name on the path, and nothing else."""
    folder.mkdir()
    program = folder / "ffmpeg"
    program.write_text(JOINS.format(python=sys.executable, fails=fails))
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(folder))


@pytest.mark.parametrize("speed", [1.0, 0.5, 4.0])
def test_frames_are_a_twenty_fifth_of_a_second_apart_at_that_speed(speed: float) -> None:
    times = np.arange(0, 2 * SECOND + 1, SECOND // 1000)
    seconds = np.array(film.moments_of(times, speed)).astype("int64") * 1e-9
    assert len(seconds) == math.ceil(2.0 / speed * 25) + 1
    assert (seconds[0], seconds[-1]) == (0.0, 2.0)
    # The last one comes up to a frame early. Half a step from the due time at most.
    assert np.diff(seconds)[:-1] == pytest.approx(speed / 25.0, abs=1e-3)


def test_each_frame_shows_the_nearest_step() -> None:
    times = np.array([0, 10, 100, 130, 400]) * (SECOND // 1000)
    shown = [int(one.astype("int64")) for one in film.moments_of(times, 1.0)]
    due = np.arange(11) * SECOND // 25
    assert shown == [int(times[np.argmin(np.abs(times - one))]) for one in due]


def test_ffmpeg_joins_the_frames(two_bodies, tmp_path, monkeypatch, shot) -> None:
    ffmpeg(tmp_path / "programs", monkeypatch)
    path = tmp_path / "films" / "a.mp4"
    assert replay.video(two_bodies, path, viewpoint=Viewpoint(speed=1.0)) == path
    assert path.read_text() == f"{len(shot)} 25"
    assert list(path.parent.iterdir()) == [path]


def test_without_ffmpeg_the_frames_are_kept_and_never_written_over(
    two_bodies, tmp_path, monkeypatch, shot
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    frames = replay.video(two_bodies, tmp_path / "a.mp4")
    assert sorted(path.name for path in frames.iterdir()) == [
        f"{number:05d}.png" for number in range(len(shot))
    ]
    with pytest.raises(UsageError, match="is there already"):
        replay.video(two_bodies, tmp_path / "a.mp4")
    assert list(tmp_path.iterdir()) == [frames]


def test_a_film_that_ffmpeg_cannot_make_leaves_nothing(
    two_bodies, tmp_path, monkeypatch, shot
) -> None:
    ffmpeg(tmp_path / "programs", monkeypatch, fails=True)
    (tmp_path / "films").mkdir()
    with pytest.raises(LavenderError, match="made no film: no such codec"):
        replay.video(two_bodies, tmp_path / "films" / "a.mp4")
    assert list((tmp_path / "films").iterdir()) == []
