"""The matrix of cases and solvers: every entry by its sign, what failed once more below."""

from __future__ import annotations

import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from lavendersim.figures.report_matrix import LOOKS, NOT_RUN, Matrix, page, write_matrix
from lavendersim.runner import matrix_entry

SOLVERS = ("adaptive", "jacobi")


def case(name: str, reduced: bool = False) -> Any:
    return SimpleNamespace(name=name, question=f"what of {name}?", reduced=reduced)


def entry(name: str, solver: str, verdict: str = "passes", margin: float = float("nan")) -> Any:
    return SimpleNamespace(case=name, solver=solver, verdict=verdict, why="sank", detail=f"{name} sank deep", margin=margin, number=0.25, least=0.2, most=0.3, claim="drift: 0.25, expected at most 0.1", cost=2e-6, contacts=12.0, iterations=2.5, log=Path(f"runs/{name}.mcap"))  # noqa: E501  # fmt: skip


def matrix(*entries: Any, left_out: dict[str, str] | None = None) -> Matrix:
    cases = [case("tall/jenga"), case("tall/tower", reduced=True), case("drop")]
    return Matrix(cases, SOLVERS, entries, left_out or {}, {}, "a processor")


def rows_of(text: str) -> dict[str, list[str]]:
    """Return the signs of each case's entries."""
    found = {}
    for row in re.findall(r"<tr[^>]*data-case=\"([^\"]*)\"(.*?)</tr>", text, re.DOTALL):
        found[row[0]] = re.findall(
            "|".join(look.sign for look in (*LOOKS.values(), NOT_RUN)), row[1]
        )
    return found


def test_every_verdict_has_a_look_of_its_own() -> None:
    assert len({look.sign for look in LOOKS.values()}) == len(LOOKS)
    named = {getattr(matrix_entry, name) for name in ("DIED", "REFUSED")}
    assert named <= LOOKS.keys()


def test_entries_stand_in_the_row_of_their_case_and_the_column_of_their_solver() -> None:
    text = page(
        matrix(
            entry("tall/jenga", "jacobi", "fails"),
            entry("tall/jenga", "adaptive"),
            entry("drop", "adaptive", "diverged"),
        ),
        Path(),
    )
    signs = {name: look.sign for name, look in LOOKS.items()}
    assert rows_of(text) == {
        "tall/jenga": [signs["passes"], signs["fails"]],
        "tall/tower": [NOT_RUN.sign] * 2,
        "drop": [signs["diverged"], NOT_RUN.sign],
    }


def test_the_key_has_what_stands_in_the_table_and_what_was_not_run() -> None:
    every = [entry(name, solver) for name in ("tall/jenga", "tall/tower", "drop") for solver in SOLVERS]  # noqa: E501  # fmt: skip
    whole = page(matrix(*every), Path())
    assert NOT_RUN.words not in whole
    assert LOOKS["diverged"].words not in whole
    assert LOOKS["fails"].words in whole  # always in the key
    one, two = (page(matrix(*every[:-k]), Path()).count(NOT_RUN.words) for k in (1, 2))
    assert one - (two - one) == 1  # beside what entries say of themselves


def test_margins_and_reasons_are_said_when_pointed_at() -> None:
    text = page(matrix(entry("drop", "jacobi", "fails", margin=-0.25)), Path())
    assert "fails: sank" in text
    assert "least margin -0.25 of a bound" in text


def test_failures_are_listed_below_solver_by_solver() -> None:
    text = page(matrix(entry("drop", "jacobi", "fails"), entry("drop", "adaptive")), Path())
    assert text.count("drop sank deep") == 1
    assert "tall/jenga sank deep" not in text


def test_links_are_relative_and_the_page_is_written_whole(tmp_path: Path) -> None:
    one = entry("drop", "jacobi")
    one.log = tmp_path / "runs" / "a b.mcap"
    write_matrix(matrix(one), tmp_path / "pages.html")
    assert 'href="runs/a%20b.mcap"' in (tmp_path / "pages.html").read_text()


@pytest.mark.parametrize("names", [("a", "b"), ("b", "a")])
def test_what_is_no_case_is_named_once_for_each_reason(names: tuple[str, str]) -> None:
    text = page(matrix(left_out=dict.fromkeys(names, "it sweeps solvers") | {"c": "other"}), Path())
    assert text.count("it sweeps solvers") == 1


def test_a_square_has_the_number_behind_its_verdict_or_says_that_the_case_was_refused() -> None:
    refused = entry("drop", "jacobi", "refused")
    refused.number, refused.claim, refused.cost = float("nan"), "", float("nan")
    refused.least = refused.most = refused.contacts = refused.iterations = float("nan")
    text = page(matrix(entry("drop", "adaptive"), refused), Path())
    squares = re.findall(r'<td class="entry.*?</td>', text, re.DOTALL)
    assert ">0.25<" in squares[-2]
    assert ">0.2 to 0.3<" in squares[-2]  # over its starts
    assert "drift: 0.25, expected at most 0.1" in squares[-2]
    assert ">12 contacts<" in squares[-2]
    assert ">2.5 iterations<" in squares[-2]
    assert "12 contacts, 2.5 iterations a step" in squares[-2]  # pointed at
    assert ">refused<" in squares[-1]
    assert "a step" not in squares[-1]
    assert "nan" not in text


def test_starts_that_agree_in_all_digits_shown_need_no_range() -> None:
    one = entry("drop", "adaptive")
    one.least, one.most = 0.25, 0.2500001
    (square,) = re.findall(r'<td class="entry passes.*?</td>', page(matrix(one), Path()), re.DOTALL)
    assert ">at every start<" in square
    assert "over its starts 0.25 to 0.25" in square  # pointed at


def test_a_solver_passes_of_the_cases_that_it_was_put_to() -> None:
    text = page(matrix(entry("drop", "adaptive"), entry("tall/jenga", "adaptive", "fails")), Path())
    ours, other = re.findall(r'<th class="solver".*?</th>', text, re.DOTALL)
    assert ours.endswith("<b>1</b> of 2</th>")
    assert other.endswith("not run</th>")


def test_what_engines_solve_stands_on_their_page() -> None:
    facts = {"jacobi": {"law": "soft contacts, a pyramid", "precision": "single"}}
    text = page(matrix(entry("drop", "jacobi"))._replace(what="engine", about=facts), Path())
    assert "<b>jacobi</b> soft contacts, a pyramid</summary>" in text
    assert "<dt>precision</dt><dd>single</dd>" in text
    assert "What they solve" not in page(matrix(entry("drop", "jacobi")), Path())
