"""Measurements of peers as a table, text or Markdown, error beside time."""

from __future__ import annotations

from typing import Any

# Ending of a measure's name: what follows the metre.
UNITS = {"_m": "", "_m_s": "/s"}
RELATIVE = ("apex_", "energy_", "momentum_", "rate_")
HEADER = ("scene", "engine", "us/step", "spread", "processor", "settled", "error")


def spoken(name: str, value: float | bool) -> str:
    """Return one measure for people: `overlap 16.2 um`, `stands`, `apex e0.5 240Hz 0.70 %`."""
    if isinstance(value, bool):
        return name if value else f"FALLEN ({name}: no)"
    for ending in sorted(UNITS, key=len, reverse=True):
        if name.endswith(ending):
            words = name.removesuffix(ending).replace("_", " ")
            factor, unit = (1.0, "m") if value >= 1.0 else (1e3, "mm")
            if value < 1e-3:
                factor, unit = 1e6, "um"
            return f"{words} {_digits(value * factor)} {unit}{UNITS[ending]}"
    words = name.replace("_", " ")
    if name.startswith(RELATIVE):
        return f"{words} {_digits(100.0 * value)} %"
    return f"{words} {value:.4g}"


def _digits(value: float) -> str:
    """Return three digits, without an exponent where that is shorter to read."""
    if value != 0.0 and (abs(value) < 0.001 or abs(value) >= 1e6):
        return f"{value:.1e}"
    return f"{value:.3g}" if abs(value) < 100 else f"{value:.0f}"


def rows(found: dict[str, Any]) -> list[tuple[str, ...]]:
    """Return the table's rows, cheapest engine first within a scene."""
    table: list[tuple[str, ...]] = []
    for scene, engines in found["scenes"].items():
        for variant, cell in sorted(
            engines.items(), key=lambda item: item[1].get("us_per_step", float("inf"))
        ):
            said = [spoken(*each) for each in cell["errors"].items()]
            if cell["failure"]:
                said.append(f"not measured: {cell['failure']}")
            if "us_per_step" not in cell:
                table.append((scene, variant, "", "", "", "", ", ".join(said)))
                continue
            middle = cell["us_per_step"]
            runs = cell["us_per_step_runs"]
            spread = (max(runs) - min(runs)) / middle
            table.append(
                (
                    scene,
                    variant,
                    _cost(middle),
                    f"{100.0 * spread:.0f} %",
                    _cost(cell["us_per_step_processor"]),
                    _cost(cell["us_per_step_settled"]),
                    ", ".join(said),
                )
            )
    return table


def _cost(microseconds: float) -> str:
    return f"{microseconds:.2f}" if microseconds < 100 else f"{microseconds:.0f}"


def as_text(found: dict[str, Any]) -> str:
    """Return the table for a terminal, what was left out, and what the columns are."""
    lines = [HEADER, *rows(found)]
    widths = [max(len(line[k]) for line in lines) for k in range(len(HEADER) - 1)]
    text = []
    for line in lines:
        cells = [
            cell.ljust(width) if k < 2 else cell.rjust(width)
            for k, (cell, width) in enumerate(zip(line, widths, strict=False))
        ]
        text.append("  ".join([*cells, line[-1]]).rstrip())
    return "\n".join([*text, "", *notes(found)])


def as_markdown(found: dict[str, Any]) -> str:
    """Return the table for a page."""
    lines = [f"| {' | '.join(HEADER)} |", "|---|---|---:|---:|---:|---:|---|"]
    lines += [f"| {' | '.join(row)} |" for row in rows(found)]
    return "\n".join([*lines, "", *(f"- {note}" for note in notes(found))])


def notes(found: dict[str, Any]) -> list[str]:
    """Return what a reader of the table must know."""
    said = [
        f"us/step: wall time of a step, mean over the run, by the median of {found['repeats']} "
        "interleaved runs for every tenth of a simulated second; spread: greatest run less least; "
        "processor: the same in processor time; settled: the last fifth of the run. "
        "Stepping only; sleeping off in every engine; one process.",
    ]
    said += [
        f"{each['variant']}: {each['version']}; {each['settings']}" for each in found["engines"]
    ]
    said += [f"{name} does not run here: {why}" for name, why in found["missing"].items()]
    return said
