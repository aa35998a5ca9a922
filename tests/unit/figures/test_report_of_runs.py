"""The report of runs: margins, failures and the cell that stands for a case."""

from __future__ import annotations

import math
import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from lavendersim.errors import TraceError
from lavendersim.figures.report import report, write_report
from lavendersim.measures.verdict import Verdict

NAN = float("nan")


def verdict(node: str, passed: bool = True, margin: float = NAN, path: str = "") -> Verdict:
    return Verdict("n", node, passed, 1.0, "at most 2", "none", "", path, margin=margin)


def cell(index: int, folder: Path, damage: str = "") -> Any:
    def trace() -> Any:
        raise TraceError(damage or "nothing to draw here")

    return SimpleNamespace(index=index, label=f"e={index}", path=folder / f"cells/{index}.mcap", status="complete", damage=lambda: damage, trace=trace, release=lambda: None)  # noqa: E501  # fmt: skip


def result(folder: Path, verdicts: list[Verdict], name: str = "drop", **more: Any) -> Any:
    cells = more.pop("cells", [cell(0, folder), cell(1, folder)])
    outcomes = [
        SimpleNamespace(accuracy=SimpleNamespace(worst_residual=1e-9 * 10**k), physics_ns=2e6, steps=1000 * (k + 1))  # noqa: E501
        for k in range(len(cells))
    ]  # fmt: skip
    config = SimpleNamespace(question="How <high>?")
    controls = more.pop("controls", ())
    experiment = SimpleNamespace(config=config, controls=controls, options=SimpleNamespace(reduced=False), is_drawn=False, path="drop.yaml")  # noqa: E501  # fmt: skip
    run = SimpleNamespace(name=name, cells=cells, experiment=experiment, cut=lambda: more.get("cut", []))  # noqa: E501  # fmt: skip
    good = all(one.passed for one in verdicts)
    ended = more.pop("ended", [])
    return SimpleNamespace(run=run, outcomes=outcomes, verdicts=verdicts, good=good and not ended, ended_early=ended)  # noqa: E501  # fmt: skip


def text_of(page: str) -> str:
    return " ".join(re.sub(r"<[^>]*>", " ", page.split("<h1>", 1)[1]).split())


def test_cases_cells_and_claims_are_counted(tmp_path: Path) -> None:
    good = result(tmp_path, [verdict("a"), verdict("b")])
    bad = result(tmp_path, [verdict("a", passed=False)], name="jenga")
    text = text_of(report([good, bad], tmp_path))
    assert "1 of 2 cases pass" in text
    assert "2 of 3 claims met in 4 cells" in text


def test_the_least_margin_is_that_of_what_failed_where_anything_did(tmp_path: Path) -> None:
    claims = [verdict("near", margin=0.01), verdict("far", margin=0.9)]
    failed = verdict("broken", passed=False, margin=0.5)  # a claim of another kind may leave some
    without = verdict("other", passed=False)
    for more, shown in (([], "0.01 near"), ([failed], "0.5 broken"), ([without], "- other")):
        page = report([result(tmp_path, [*claims, *more])], tmp_path)
        found = re.search(r'data-head="margin">(.*?)</td>', page, re.DOTALL)
        assert found is not None
        assert " ".join(re.sub(r"<[^>]*>", " ", found[1]).split()) == shown


def test_the_worst_residual_and_the_range_of_costs(tmp_path: Path) -> None:
    text = text_of(report([result(tmp_path, [])], tmp_path))
    assert "1e-08" in text  # the larger of 1e-9 and 1e-8
    assert "1 to 2" in text  # 2 ms over 1000 and 2000 steps, in us


def test_the_first_cell_that_failed_stands_for_its_case(tmp_path: Path) -> None:
    claims = [verdict("a", passed=False, path=str(tmp_path / "cells/1.mcap"))]
    row = report([result(tmp_path, claims)], tmp_path).split('<tr class="more"')[0]
    assert re.findall(r'href="([^"]*)"', row) == ["cells/1.mcap"]
    row = report([result(tmp_path, [verdict("a")])], tmp_path).split('<tr class="more"')[0]
    assert re.findall(r'href="([^"]*)"', row) == ["cells/0.mcap"]


def test_declared_failures_and_ends_are_said(tmp_path: Path) -> None:
    ended = SimpleNamespace(index=1, label="e=1", status="diverged: ball", path=tmp_path / "cells/1.mcap")  # noqa: E501  # fmt: skip
    controls = [SimpleNamespace(fails="energy"), SimpleNamespace(fails="energy")]
    one = result(tmp_path, [], ended=[ended], controls=controls)
    text = text_of(report([one], tmp_path))
    assert text.count("energy fails, as declared") == 1
    assert "e=1: diverged: ball" in text


def test_damaged_logs_stand_in_the_page_and_are_returned(tmp_path: Path) -> None:
    cells = [cell(0, tmp_path, "0.mcap: cut"), cell(1, tmp_path)]
    one = result(tmp_path, [], cells=cells, cut=["1.mcap: cut", "0.mcap: cut"])
    one.run.cut = lambda: ["1.mcap: cut", "0.mcap: cut"]
    found = write_report([one], tmp_path / "page.html")
    assert found == ["0.mcap: cut", "1.mcap: cut"]
    text = text_of((tmp_path / "page.html").read_text())
    assert "1.mcap: cut" in text


@pytest.mark.parametrize("steps", [0, 1])
def test_a_cell_without_steps_costs_no_division(tmp_path: Path, steps: int) -> None:
    one = result(tmp_path, [])
    for outcome in one.outcomes:
        outcome.steps, outcome.physics_ns = steps, 3000.0
    assert ">3</td>" in report([one], tmp_path).replace("\n", "")
    assert not math.isnan(one.outcomes[0].physics_ns)


def test_what_failed_has_the_command_that_shows_it(tmp_path: Path) -> None:
    log = str(tmp_path / "cells/1.mcap")
    failed = [verdict("a", passed=False, path=log), verdict("b", passed=False, path=log)]
    text = text_of(report([result(tmp_path, failed)], tmp_path))
    assert text.count(f"lavender replay {tmp_path} --cell 1") == 1
    assert "lavender replay" not in text_of(report([result(tmp_path, [verdict("a")])], tmp_path))


def test_when_and_with_what_it_was_made(tmp_path: Path) -> None:
    page = report([result(tmp_path, [])], tmp_path, {"made": "today", "command": "lavender <x>"})
    assert "made today command lavender &lt;x&gt;" in text_of(page)


def test_words_of_a_config_are_words(tmp_path: Path) -> None:
    assert "How &lt;high&gt;?" in report([result(tmp_path, [])], tmp_path)
