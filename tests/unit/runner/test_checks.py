"""Every defect that only the plan or the machine shows is found before a run, and all at once."""

from __future__ import annotations

from pathlib import Path

import pytest

from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment
from lavendersim.runner import problem_dump
from lavendersim.runner.checks import check
from tests.drop_config import DROP

DEFECTS = {
    "overhead": "overhead: {effects: [drga]}\n",
    "effects": "effects: {gravity: off}\n",
    "record": "record: {problems: every 10}\n",
}


def refused(path: Path, text: str) -> list[tuple[int, str]]:
    path.write_text(text)
    with pytest.raises(ConfigError) as caught:
        check(load_experiment(path))
    return [(defect.line, defect.message) for defect in caught.value.defects]


@pytest.fixture(autouse=True)
def without_h5py(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(problem_dump, "find_spec", lambda name: None)


@pytest.mark.parametrize("section", DEFECTS)
def test_each_defect_is_refused_in_its_line(section: str, tmp_path: Path) -> None:
    ((line, message),) = refused(tmp_path / "drop.yaml", DROP + DEFECTS[section])
    assert line == len(DROP.splitlines()) + 1
    assert section in message


@pytest.mark.parametrize("sections", [list(DEFECTS), list(DEFECTS)[::-1]])
def test_all_of_them_are_refused_in_the_order_of_the_file(
    sections: list[str], tmp_path: Path
) -> None:
    text = DROP + "".join(DEFECTS[section] for section in sections)
    found = refused(tmp_path / "drop.yaml", text)
    first = len(DROP.splitlines()) + 1
    assert [line for line, _ in found] == [first, first + 1, first + 2]
    assert all(section in message for section, (_, message) in zip(sections, found, strict=True))


def test_an_experiment_that_asks_for_none_of_it_passes(tmp_path: Path) -> None:
    path = tmp_path / "drop.yaml"
    path.write_text(DROP)
    check(load_experiment(path))
