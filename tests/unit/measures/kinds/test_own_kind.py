"""A kind of `measures.py` is taken by its function, with the parameters of the config."""

from __future__ import annotations

from pathlib import Path

import pytest
from synthetic import trace_of

from lavendersim.errors import UsageError
from lavendersim.measures import evaluate
from lavendersim.measures.own_file import read_own
from lavendersim.measures.specs.own import FromFile

TEXT = """\
from lavendersim.measures import Trace, own_measure


@own_measure
def peak(trace: Trace, above: float = 0.0) -> float:
    return float(trace.pose[:, 1, 2].max()) - above
"""


def spec_of(digest: str, **parameters: float) -> FromFile:
    given = {"kind": "from_file", "function": "peak", "sha256": digest, "parameters": parameters}
    return FromFile.model_validate(given)


def test_the_function_gets_the_log_and_its_parameters(tmp_path: Path) -> None:
    (tmp_path / "measures.py").write_text(TEXT)
    digest = read_own(tmp_path / "measures.py").sha256
    log = trace_of([0.5, 0.75, 0.25])  # the centre of a ball of 0.1 m
    assert evaluate(spec_of(digest), log) == pytest.approx(0.85)
    assert evaluate(spec_of(digest, above=0.1), log) == pytest.approx(0.75)


def test_a_file_that_nobody_named_is_not_run() -> None:
    with pytest.raises(UsageError, match=r"measures\.py"):
        evaluate(spec_of("0" * 64), trace_of([0.5]))
