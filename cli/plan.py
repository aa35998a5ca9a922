"""`lavender plan`: prints which effects a scene requires, why, and what each brings."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from lavender_cli import printing
from lavender_cli.run import Set, Strict, Sweep, overrides_of

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.table import Table

    from lavendersim.experiment import Experiment
    from lavendersim.scene.explanation import Explanation, ExplanationItem

UNWRAPPED = 100_000  # columns: in a pipe no line is broken
STYLES = {"on": "green", "off": "dim", "forced on": "bold yellow", "forced off": "bold yellow"}
ROWS = {
    "step_row": "/step",
    "contact_row": "/contacts",
    "pose_row": "/tf",
    "residual_row": "/residuals",
}


def plan(
    configs: Annotated[
        list[Path], typer.Argument(help="Config files, or folders of them.", show_default=False)
    ],
    values: Set = None,
    axes: Sweep = None,
    strict: Strict = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the plan as JSON.")] = False,
) -> None:
    """Show which effects a scene requires, why, and what each brings: arrays, log, kernels.

    For a sweep the plan is the union over its cells, and names the cells that require each. Cells
    that differ in a choice between laws, such as the solver, share no union: one plan each.
    As JSON one config is an object, several are a list of them.
    """
    from lavendersim.runner import load_all

    experiments = load_all(configs, overrides=overrides_of(values, axes), strict=strict)
    if as_json:
        documents = [_document(each, *_planned(each)) for each in experiments]
        printing.as_json(documents[0] if len(documents) == 1 else documents)
        return
    for number, each in enumerate(experiments):
        if number:
            typer.echo()
        _print(each, *_planned(each))


def _planned(experiment: Experiment) -> tuple[list[Explanation], list[str], list[int]]:
    """Return the plans of an experiment, its engines that plan by themselves, sizes of logs."""
    from lavendersim.peers.catalogue import LAVENDER
    from lavendersim.runner.log_size import expected_log_sizes
    from lavendersim.runner.plans import distinct, shared_plans
    from lavendersim.scene.explanation import explain_all

    cells = experiment.cells()
    plans = shared_plans(cells)
    every = distinct(plans)
    own = [one for one in every if one.engine == LAVENDER]
    others = [one.engine for one in every if one.engine != LAVENDER]
    sizes = expected_log_sizes(cells, plans, experiment.text)
    return explain_all(own) if own else [], others, sizes


def _document(
    experiment: Experiment, explained: list[Explanation], others: list[str], sizes: list[int]
) -> dict[str, Any]:
    from lavendersim.peers.catalogue import facts_of

    tables = [one.as_data() for one in explained]
    numbers = [
        {"path": one.path, "number": one.number, "formula": one.text, "place": one.mark[:2]}
        for one in experiment.numbers()
    ]
    first = tables[0] if tables else {}
    document = {
        "experiment": experiment.name,
        **first,
        "others": tables[1:],
        "expected_log_sizes": sizes,
    }
    document |= {"engines": [facts_of(name) for name in others]} if others else {}
    return document | ({"formulas": numbers} if numbers else {})


def _print(
    experiment: Experiment, explained: list[Explanation], others: list[str], sizes: list[int]
) -> None:
    from lavendersim.peers.catalogue import facts_of

    for one in explained:
        write(one, f"{experiment.name}: {one.title}")
    for name in others:
        typer.echo(f"{experiment.name}: engine {name}, which plans by itself")
        for what, said in facts_of(name).items():
            typer.echo(f"  {what:<10} {said}")
    for line in number_lines(experiment):
        typer.echo(line)
    for line in size_lines(sizes, [cell.label for cell in experiment.cells()]):
        typer.echo(line)


def number_lines(experiment: Experiment) -> list[str]:
    """Return the numbers that formulas gave, each with its formula and place; none without any.

    Those that depend on a swept constant are listed for the first cell.
    """
    found = experiment.numbers()
    if not found:
        return []
    first = experiment.cells()[0].label
    lines = [f"numbers from formulas{f', of the first cell ({first})' if first else ''}"]
    for one in found:
        file = one.mark.file or str(experiment.path)
        place = f"{file}:{one.mark.line}:{one.mark.column}"
        lines.append(f"  {one.path} = {one.number!r}  from  {one.text}  at {place}")
    return lines


def size_lines(sizes: list[int], labels: list[str]) -> list[str]:
    """Return about how large the logs will be, in all and by cell; of many cells the range."""
    total, low, high = (_about(size) for size in (sum(sizes), min(sizes), max(sizes)))
    if len(sizes) == 1:
        return [f"expected size of the log: about {total}"]
    each = low if low == high else f"{low} to {high}"
    lines = [f"expected size of the logs: about {total}, {each} in each of {len(sizes)} cells"]
    if len(sizes) <= printing.CELLS_SHOWN:
        lines += [
            f"  {_about(size):>7}  {label}" for size, label in zip(sizes, labels, strict=True)
        ]
    return lines


def _about(size: int) -> str:
    text: str = printing.byte_size(size, digits=2)
    return text


def write(explained: Explanation, title: str, width: int | None = None) -> None:
    """Print one plan, wrapped to the terminal; a pipe gets whole lines."""
    with printing.by_rich(width, UNWRAPPED) as console:
        console.print(title, style="bold")
        if (mistake := explained.choices["mistake"]) in explained.spec["effects"]:
            console.print(f"study-only: {mistake}, a deliberate error", style="bold yellow")
        console.print(_table(explained.effects, "effect"))
        console.print(_table([one for one in explained.shape_pairs if one.on], "shape pair"))
        if others := [one.name for one in explained.shape_pairs if not one.on]:
            console.print(_pairs([("not required", ", ".join(others))], dim=True))
        console.print()
        console.print(_table([explained.solver], "solver"))
        console.print("kernels without any effect", style="bold")
        console.print(_pairs(list(_modules(explained.always).items())))
        if explained.shared:
            console.print("kernels that several effects share", style="bold")
            console.print(_pairs(list(_modules(explained.shared).items())))
        laws = [
            (name, str(value).lower() if isinstance(value, bool) else str(value))
            for name, value in explained.choices.items()
        ]
        console.print("choices that one engine has", style="bold")
        console.print(_pairs([*laws, ("digest", explained.digest)]))
        console.print("threads of a step, by --threads", style="bold")
        console.print(explained.threads)


def _table(parts: list[ExplanationItem], heading: str) -> Table:
    """Return a row per part: its name, whether it is in, why and what it brings."""
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, padding=(0, 2, 0, 0), header_style="bold", pad_edge=False)
    table.add_column(heading, no_wrap=True)
    table.add_column("")
    table.add_column("why, and what it brings")
    for part in parts:
        word = "on" if part.on else "off"
        style = STYLES[part.forced or word]
        table.add_row(
            Text(part.name, "" if part.on or part.forced else "dim"),
            Text(word, style),
            _why(part),
        )
    return table


def _why(part: ExplanationItem) -> RenderableType:
    from rich.console import Group
    from rich.text import Text

    reason = Text(f"{part.reason}; {part.requirement}" if part.requirement else part.reason)
    if not part.on:
        reason.stylize("" if part.forced else "dim")
        return reason
    arrays = {record: names for record, names in part.fields.items() if record not in ROWS}
    rows = {ROWS[record]: names for record, names in part.fields.items() if record in ROWS}
    channels = [channel for channel in part.channels if channel not in rows]
    logged = [
        *channels,
        *(f"{topic} {len(names)}: {' '.join(names)}" for topic, names in rows.items()),
    ]
    details = [
        ("arrays", "; ".join(f"{name} {len(n)}: {' '.join(n)}" for name, n in arrays.items())),
        ("log", "; ".join(logged)),
        ("kernels", "; ".join(f"{module}: {n}" for module, n in _modules(part.kernels).items())),
    ]
    brought = [(name, text) for name, text in details if text]
    # An empty table is as wide as the console, and so would be every line of the one it is in.
    return Group(reason, _pairs(brought, dim=True)) if brought else reason


def _modules(kernels: dict[str, list[str]]) -> dict[str, str]:
    return {module: " ".join(names) for module, names in kernels.items()}


def _pairs(rows: list[tuple[str, str]], dim: bool = False) -> Table:
    """Return names and what belongs to them, side by side."""
    from rich.table import Table

    table = Table.grid(padding=(0, 2, 0, 0))
    table.style = "dim" if dim else ""
    table.add_column(no_wrap=True)
    table.add_column()
    for name, text in rows:
        table.add_row(name, text)
    return table
