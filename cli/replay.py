"""`lavender replay`: shows a cell in rerun's viewer, or writes a recording or a picture."""

from __future__ import annotations

import math
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from lavender_cli import printing
from lavender_cli.completion import run_names
from lavender_cli.run import AllowIncomplete, Runs

if TYPE_CHECKING:
    from lavendersim.replay import Viewpoint
    from lavendersim.runner import Run, RunCell


def replay(
    run: Annotated[
        Path | None,
        typer.Argument(
            metavar="[RUN]",
            help="Run directory; the latest finished run by default.",
            autocompletion=run_names,
        ),
    ] = None,
    other: Annotated[
        Path | None,
        typer.Argument(metavar="[OTHER]", help="Another run, to be shown beside it."),
    ] = None,
    cell: Annotated[
        int | None,
        typer.Option("--cell", metavar="K", help="Which cell of the sweep, counted from 0."),
    ] = None,
    other_cell: Annotated[
        int | None,
        typer.Option(
            "--other-cell",
            metavar="K",
            help="Which cell of the other run; that at the same coordinates by default.",
        ),
    ] = None,
    overlay: Annotated[
        bool,
        typer.Option("--overlay", help="Show the other run's bodies as pale lines over the first."),
    ] = False,
    at: Annotated[
        float | None,
        typer.Option("--at", metavar="SECONDS", help="Stop at this simulated time."),
    ] = None,
    runs: Runs = Path("runs"),
    save_to: Annotated[
        Path | None,
        typer.Option("--save", metavar="FILE.rrd", help="Write a rerun recording; open nothing."),
    ] = None,
    screenshot_to: Annotated[
        Path | None,
        typer.Option(
            "--screenshot",
            metavar="FILE.png",
            help="Write a picture of the viewer at --at or the last contact; needs no display.",
        ),
    ] = None,
    video_to: Annotated[
        Path | None,
        typer.Option(
            "--video",
            metavar="FILE.mp4",
            help="Write a film of the viewer, or its frames without ffmpeg; needs no display.",
        ),
    ] = None,
    camera: Annotated[
        str,
        typer.Option(
            "--camera",
            metavar="WHERE",
            help="See it from front, back, left, right, above, or from X,Y,Z in metres.",
        ),
    ] = "",
    follow: Annotated[
        str, typer.Option("--follow", metavar="BODY", help="Move the camera with this body.")
    ] = "",
    speed: Annotated[
        float | None,
        typer.Option(
            "--speed", metavar="X", help="Simulated seconds per second; slow by default if short."
        ),
    ] = None,
    live: Annotated[
        bool,
        typer.Option(
            "--live", help="Follow a cell that is still run, of the newest run by default."
        ),
    ] = False,
    copy: Annotated[Path | None, typer.Option("--copy", hidden=True)] = None,  # of `run --live`
    allow_incomplete: AllowIncomplete = False,
) -> None:
    """Replay a run in rerun: bodies, contact forces and their plots over simulated time.

    Two runs are shown side by side, or overlaid, with the distance of each body from itself in the
    other. Exits 3 when a log is damaged.
    """
    from lavendersim import replay as viewer
    from lavendersim.errors import UsageError
    from lavendersim.runner import open_run

    for path, suffix in ((save_to, ".rrd"), (screenshot_to, ".png"), (video_to, ".mp4")):
        if path is not None and path.suffix != suffix:
            raise UsageError(f"{path}: the name of this file ends in {suffix}")
    viewpoint = viewpoint_of(camera, follow, speed)
    if save_to is not None and at is not None and screenshot_to is None:
        raise UsageError("--at: an .rrd file has no place for it; leave out --save or --at")
    if video_to is not None and at is not None and screenshot_to is None:
        raise UsageError("--at: a film shows all times; leave out --video or --at")
    if other is None and (overlay or other_cell is not None):
        option = "--overlay" if overlay else "--other-cell"
        raise UsageError(f"{option}: name another run beside it")
    if live:
        asked = {"OTHER": other, "--at": at, "--screenshot": screenshot_to, "--video": video_to}
        if given := [option for option, value in asked.items() if value is not None]:
            raise UsageError(f"{given[0]}: leave it out, or --live: that shows a log as it grows")
        _follow(run, runs, cell or 0, viewpoint, save_to, copy)
        return
    opened = open_run(run, runs, allow_incomplete)
    chosen = [cell_of(opened, cell or 0)]
    if other is not None:
        from lavendersim.comparison.pairing import partner

        beside = open_run(other, runs, allow_incomplete)
        found = other_cell if other_cell is not None else partner(opened, chosen[0], beside)
        chosen.append(cell_of(beside, found))
    if cell is None and len(opened.cells) > 1:
        others = f"0 to {len(opened.cells) - 1}"
        shown = f"replaying cell 0 ({chosen[0].label}); --cell K shows another, {others}"
        typer.echo(shown, err=True)

    damaged = list(filter(None, [one.damage() for one in chosen]))
    printing.report_damage(damaged, "nothing is shown" if not allow_incomplete else "")
    traces = [one.trace() for one in chosen]
    whole = ", ".join(str(len(one.step)) for one in traces) if damaged else ""
    part = f"(INCOMPLETE: {whole} steps are whole)" if damaged else ""
    title = " ".join(filter(None, [opened.path.name, chosen[0].label, part]))
    shown_trace: Any = traces[0]
    if other is not None:
        names = [" ".join(filter(None, [one.path.parent.parent.name, one.label])) for one in chosen]
        title = " ".join(filter(None, [names[0], "and", names[1], part]))
        shown_trace = viewer.pair_of(traces[0], traces[1], (names[0], names[1]), overlay)
    if save_to is not None:
        viewer.save(shown_trace, save_to, title, viewpoint)
        typer.echo(save_to)
    if screenshot_to is not None:
        for complaint in viewer.screenshot(shown_trace, screenshot_to, title, at, viewpoint):
            typer.echo(f"rerun's viewer: {complaint}", err=True)
        typer.echo(screenshot_to)
    if video_to is not None:
        written = viewer.video(shown_trace, video_to, title, viewpoint)
        if written != video_to:
            typer.echo("ffmpeg is not installed: these are the frames of the film", err=True)
        typer.echo(written)
    if save_to is None and screenshot_to is None and video_to is None:
        viewer.open_viewer(shown_trace, title, at, viewpoint)
    if damaged:
        raise typer.Exit(printing.DAMAGED)


def _follow(
    run: Path | None,
    runs: Path,
    cell: int,
    viewpoint: Viewpoint,
    save_to: Path | None,
    copy: Path | None,
) -> None:
    """Show a cell of a run that goes on; copy: of its log, ahead of it."""
    from lavendersim import replay as viewer
    from lavendersim.errors import UsageError
    from lavendersim.runner import open_run
    from lavendersim.runner.run_directory import list_runs
    from lavendersim.runner.run_lock import is_locked

    if run is None:
        found = list_runs(runs)
        if not found:
            raise UsageError(f"{runs} has no run: start one with `lavender run CONFIG`")
        run = found[-1].path
    opened = open_run(run, runs, True)
    chosen = cell_of(opened, cell)
    title = f"{opened.path.name} {chosen.label}".strip()
    written = partial(is_locked, opened.path)
    viewer.follow(chosen.path, written, title, viewpoint, save_to=save_to, copy=copy)
    if save_to is not None:
        typer.echo(save_to)


def viewpoint_of(camera: str, follow: str, speed: float | None) -> Viewpoint:
    """Return what the options say of the view; UsageError where one cannot be."""
    from lavendersim.errors import UsageError
    from lavendersim.replay.viewpoint import Viewpoint, camera_from

    if speed is not None and not 0.0 < speed < math.inf:
        raise UsageError(f"--speed: expected a number above 0, got {speed:g}")
    return Viewpoint(camera_from(camera) if camera else "", follow, speed)


def cell_of(run: Run, number: int) -> RunCell:
    """Return a cell of a run by its number; UsageError where there is none."""
    from lavendersim.errors import UsageError

    if not 0 <= number < len(run.cells):
        raise UsageError(
            f"{run.path} has cells 0 to {len(run.cells) - 1}; there is no cell {number}"
        )
    return run.cells[number]
