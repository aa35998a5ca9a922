"""`lavender run`: runs configs into logs and results, prints a summary and draws the figures."""

from __future__ import annotations

import os
import shlex
from collections.abc import Callable
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from lavender_cli import claims, overheads, printing, progress, time_errors
from lavender_cli.completion import run_names
from lavender_cli.drawing import Drawing
from lavender_cli.going_on import as_words, command_of, interruptible, on_full_disk
from lavender_cli.live import shown_live
from lavender_cli.prediction import Yes, confirm, with_refined
from lavender_cli.watch import again

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from lavendersim.runner.cell_jobs import Prepared

DASK = "dask"

Configs = Annotated[
    list[Path], typer.Argument(metavar="CONFIG...", help="Config files, or folders of them.")
]
Jobs = Annotated[
    int, typer.Option("--jobs", "-j", min=1, help="Processes; logs are the same for any number.")
]
Threads = Annotated[
    int | None,
    typer.Option(
        "--threads",
        metavar="N",
        min=1,
        max=32,
        help="That share the sweeps of a large scene; logs are the same for any number.",
    ),
]
Refine = Annotated[
    bool,
    typer.Option("--refine", help="Run again at h/2 and h/4: each measure's time error."),
]
AllowIncomplete = Annotated[
    bool,
    typer.Option(
        "--allow-incomplete",
        help="Of damaged logs take what is whole, marked; exits 3 all the same.",
    ),
]
Set = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="PATH=VALUE", help="Instead of the config's value; repeatable."),
]
Sweep = Annotated[
    list[str] | None,
    typer.Option("--sweep", metavar="NAME=PATH:[VALUES]", help="Another axis; repeatable."),
]
Engines = Annotated[
    list[str] | None,
    typer.Option(
        *("--engine", "-e"),
        metavar="NAME",
        help="What simulates it, with commas between several; `all`: every one installed.",
    ),
]
Starts = Annotated[
    int | None,
    typer.Option(
        "--starts",
        metavar="N",
        help="Start N times: as written, then with every body moved a little, drawn by seed; 3 "
        "where several engines are compared.",
    ),
]
Strict = Annotated[
    bool, typer.Option("--strict", help="What of a config is suspicious is an error.")
]


def _run_own(paths: list[Path] | None) -> list[Path] | None:
    if paths:
        from lavendersim.measures.own_file import read_own

        for path in paths:
            read_own(path)
    return paths


Own = Annotated[
    list[Path] | None,
    typer.Option(
        "--measures",
        metavar="FILE",
        callback=_run_own,
        help="A measures.py that the run was made with; it is run. Repeatable.",
    ),
]
Runs = Annotated[Path, typer.Option("--runs", metavar="DIR", help="Where runs are kept.")]
LatestRun = Annotated[
    Path | None,
    typer.Argument(
        metavar="[RUN]", help="Run directory; the latest by default.", autocompletion=run_names
    ),
]
LatestRuns = Annotated[
    list[Path] | None,
    typer.Argument(
        metavar="[RUN]...",
        help="Run directories; the latest by default.",
        autocompletion=run_names,
    ),
]


def run(
    configs: Configs,
    plot: Annotated[bool, typer.Option("--plot", help="Draw the figures afterwards.")] = False,
    jobs: Jobs = 1,
    threads: Threads = None,
    runs: Runs = Path("runs"),
    refine: Refine = False,
    values: Set = None,
    axes: Sweep = None,
    engine: Engines = None,
    strict: Strict = False,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on with the newest run where it did not finish.")
    ] = False,
    tags: Annotated[
        list[str] | None,
        typer.Option("--tag", metavar="TAG", help="A word to find it by; repeatable."),
    ] = None,
    executor: Annotated[
        str | None, typer.Option("--executor", metavar="dask", help="Whose workers run the cells.")
    ] = None,
    dask: Annotated[
        str | None,
        typer.Option("--dask", metavar="ADDRESS", help="Of Dask's scheduler: tcp://host:8786."),
    ] = None,
    quick: Annotated[
        bool,
        typer.Option(
            "--quick", help="Overheads of the effects that a scene requires alone, in few rounds."
        ),
    ] = False,
    yes: Yes = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the results as JSON.")] = False,
    into: Annotated[
        Path | None,
        typer.Option("--into", metavar="DIR", help="Cells alone, beside others; see `merge`."),
    ] = None,
    shard: Annotated[
        str | None, typer.Option("--shard", metavar="K/N", help="With --into: part K of N.")
    ] = None,
    live: Annotated[
        bool, typer.Option("--live", help="Show the first cell in rerun's viewer as it is run.")
    ] = False,
    watch: Annotated[
        bool, typer.Option("--watch", help="Run again whenever a file of it is saved.")
    ] = False,
) -> None:
    """Run experiments, log every step, judge what was expected. Exits 1 when a check fails."""
    if watch:
        given = {**locals(), "watch": False}  # the parameters: nothing else is known yet
        if into is not None or shard is not None or resume:
            option = "--resume" if resume else "--into"
            raise typer.BadParameter(f"{option}: watched runs are whole", param_hint="--watch")
        again(configs, lambda: run(**given))
        return
    share_sweeps(threads)
    if into is not None or shard is not None:
        asked = {"--plot": plot, "--refine": refine, "--resume": resume, "--json": as_json}
        asked |= {
            "--quick": quick,
            "--live": live,
            "--tag": bool(tags),
            "--executor": executor is not None,
            "--dask": dask is not None,
        }
        overrides = overrides_of(values, axes, engine)
        _run_shard(configs, overrides, strict, _Place(into, shard, threads), jobs, asked)
        return

    if live:
        from lavendersim.replay.drivers import require_display

        require_display()
    if executor not in (None, DASK):
        raise typer.BadParameter(f"{executor!r}, expected {DASK!r}", param_hint="--executor")
    # Every file is read before the first run, so a defect anywhere leaves nothing half done.
    overrides = overrides_of(values, axes, engine)
    options = {
        "--runs": runs if runs != Path("runs") else None,
        "--jobs": jobs if jobs > 1 else None,
        "--threads": threads,
        "--executor": executor,
        "--dask": dask,
        "--tag": tags,
        "--quick": quick,
        "--strict": strict,
        "--refine": refine,
        "--plot": plot,
        "--json": as_json,
    }
    command = command_of("run", configs, overrides, "--resume", *as_words(options))
    with interruptible(command):
        from lavendersim.runner import finished_run, load_all
        from lavendersim.runner import run as run_experiment
        from lavendersim.runner.prediction import planned_before

        experiments = load_all(configs, overrides=overrides, strict=strict)
        if quick:
            from lavendersim.experiment.sweeps.quick import quick as in_few_rounds

            experiments = [in_few_rounds(one) for one in experiments]
        printing.warn_of_untried(experiments)
        good, tables, with_overheads = True, [], []
        planned: list[Prepared | None] = [None] * len(experiments)
        if not resume:  # it was asked before
            planned = [planned_before(one, 1 if executor or dask else jobs) for one in experiments]
            each = (with_refined(one) if refine else [one] for one in experiments)
            confirm(each, runs, jobs, yes, [one for one in planned if one])
    with interruptible(command), Drawing(experiments if plot else ()) as drawing:
        for number, experiment in enumerate(experiments):
            figures: list[Path] = []
            whole = finished_run(experiment, runs) if resume else None
            if whole is not None:
                name = experiment.name
                typer.echo(f"{name}: finished, nothing to resume: {whole.path}", err=True)
                results = whole.results()
                good = good and results.passed
                drawn = plot and experiment.is_drawn  # what was ended may have been its figures
                if as_json:
                    tables.append({**results.as_json, "run": whole.path, "figures": figures})
                if drawn:
                    drawing.draw(number, whole)
                    drawing.take(figures.extend if as_json else _print_figures)
                continue
            printing.warn_of_mistakes(experiment)
            with on_full_disk(command), ExitStack() as open_now:
                shown = open_now.enter_context(progress.reporting(experiment.name))
                if live:
                    began, copy = open_now.enter_context(shown_live())
                    shown = shown._replace(began=began, copy=copy)
                workers: Executor | None = None
                if executor is not None or dask is not None:
                    from lavendersim.runner.dask_cluster import dask_workers

                    workers = open_now.enter_context(dask_workers(dask, jobs))
                finished = run_experiment(
                    experiment,
                    runs,
                    jobs,
                    shown,
                    resume=resume,
                    tags=tags or (),
                    executor=workers,
                    is_predicted=not resume,
                    prepared=planned[number],
                )
            good = good and finished.good
            printing.warn_of_not_converged(finished)
            drawn = plot and experiment.is_drawn
            if drawn:
                drawing.draw(number, finished.run)
            if experiment.config.overhead is not None:
                with_overheads.append(finished.run)
            refined = time_errors.refine(finished, jobs) if refine else []
            take: Callable[[list[Path]], None] = _print_figures
            if as_json:
                results = finished.run.results()
                table = {**results.as_json, "run": finished.run.path, "figures": figures}
                if refine:
                    table["time_errors"] = time_errors.as_table(refined)
                tables.append(table)
                take = figures.extend
            else:
                drawing.say(partial(print_finished, finished, refined if refine else None))
            if drawn:
                drawing.take(take)
            if experiment.config.overhead is not None:
                overheads.raise_interrupted(finished.run)
    if plot and len(with_overheads) > 1:
        from lavendersim.figures import draw_overheads

        for figure in draw_overheads(with_overheads, with_overheads[-1].path / "figures"):
            typer.echo(f"  figure of all overheads {figure}", err=as_json)
    if as_json:
        printing.as_json(tables)
    if not good:
        raise typer.Exit(1)


def share_sweeps(threads: int | None) -> None:
    """Let steps of this process, and of those it begins, have so many threads; None: as before."""
    if threads is not None:
        os.environ["LAVENDER_THREADS"] = str(threads)
    if "LAVENDER_THREADS" in os.environ:
        from lavendersim.runner.threads import threads_asked

        threads_asked()  # refused before anything is read


def print_finished(finished: Any, refined: Any = None) -> None:
    """Print what became of a run, and its time errors where they were taken."""
    printing.print_costs(finished)
    claims.print_claims(finished.verdicts)
    printing.print_unjudged(finished)
    claims.print_failures(finished.ended_early, finished.verdicts)
    typer.echo(f"  logs  {finished.run.path}")
    if refined is not None:
        time_errors.print_table(refined)
    if finished.run.experiment.config.overhead is not None:  # else all results are read for none
        overheads.print_table(finished.run)


def _print_figures(figures: list[Path]) -> None:
    for figure in figures:
        typer.echo(f"  figure {figure}")


class _Place(NamedTuple):
    """The folder that workers share, and which part of the cells is this one's: K/N; None: any."""

    into: Path | None
    shard: str | None
    threads: int | None


def _run_shard(
    configs: list[Path],
    overrides: list[str],
    strict: bool,
    place: _Place,
    jobs: int,
    asked: dict[str, bool],
) -> None:
    """Run cells into a folder that other workers share; nothing is judged before the merge."""
    from lavendersim.errors import UsageError

    into, shard, threads = place
    if into is None:
        raise UsageError("--shard: expected --into DIR, the folder that its cells are run into")
    if refused := [option for option, given in asked.items() if given]:
        raise UsageError(f"{refused[0]} with --into: cells are not judged before `lavender merge`")
    options = {"--into": into, "--shard": shard, "--jobs": jobs if jobs > 1 else None}
    options |= {"--threads": threads}
    given = as_words({**options, "--strict": strict})
    command = command_of("run", configs, overrides, *given)
    with interruptible(command), on_full_disk(command):
        from lavendersim.runner import load_all
        from lavendersim.runner.shards import part_of, run_shard

        part = part_of(shard) if shard is not None else None
        experiments = load_all(configs, overrides=overrides, strict=strict)
        if len(experiments) > 1:
            raise UsageError(f"--into {into}: expected one config, not {len(experiments)}")
        experiment = experiments[0]
        printing.warn_of_untried(experiments)
        printing.warn_of_mistakes(experiment)
        with progress.reporting(experiment.name) as shown:
            done = run_shard(experiment, into, part, jobs, shown)
    for sentence in done.lost:
        typer.echo(f"{experiment.name}: {sentence}", err=True)
    of = "" if shard is None else f" of part {shard}"
    closed = f"{done.measured} measured whose logs were closed, " if done.measured else ""
    typer.echo(
        f"{typer.style(experiment.name, bold=True)}: {done.ran} cells run here, {closed}"
        f"{done.ended} of {done.cells}{of} have ended; {done.shard}"
    )
    typer.echo(f"  judge and draw all with: lavender merge {shlex.quote(str(into))}")
    if done.lost:
        raise typer.Exit(1)


def overrides_of(
    values: list[str] | None, axes: list[str] | None, engines: list[str] | None = None
) -> list[str]:
    """Return the options as `load_experiment` takes them."""
    given = [*(f"set {one}" for one in values or ()), *(f"sweep {one}" for one in axes or ())]
    if not engines:
        return given
    from lavendersim.peers import catalogue

    return given + catalogue.overrides_of(catalogue.chosen(engines))
