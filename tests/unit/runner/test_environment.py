"""The machine of a run: versions as installed, and kernels counted in files and bytes."""

from __future__ import annotations

from importlib.metadata import version
from types import SimpleNamespace
from typing import Any

import pytest

from lavendersim.runner.environment import (
    PACKAGES,
    Kernels,
    about,
    machine,
    processor,
    versions,
)


def test_versions_are_those_that_are_installed() -> None:
    assert versions()["numba"] == version("numba")
    assert versions().keys() == {"lavender", *PACKAGES}


def test_the_processor_has_a_name_and_the_machine_its_versions() -> None:
    assert processor()
    assert machine().items() >= versions().items()


def test_what_made_a_page_stands_in_it_as_a_shell_takes_it() -> None:
    made = about(["check", "a b.yaml"])
    assert made["command"] == "lavender check 'a b.yaml'"
    assert version("numba") in made["versions"]
    assert made["machine"].startswith(processor())


@pytest.mark.parametrize(
    ("sizes", "words"),
    [([], "0 files, 0.0 MB"), ([1_500_000], "1 file, 1.5 MB"), ([10, 20], "2 files, 0.0 MB")],
)
def test_kernels_in_words(sizes: list[int], words: str) -> None:
    kept: Any = [SimpleNamespace(size=size) for size in sizes]
    assert str(Kernels.of(kept)) == words
