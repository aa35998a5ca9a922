"""A measure of a file is taken in other processes, which have not read the file."""

from __future__ import annotations

import pickle
import subprocess
import sys
from pathlib import Path

from lavendersim.measures.own_file import read_own
from lavendersim.measures.specs.own import FromFile

OWN = """\
from lavendersim.measures import Trace, own_measure


@own_measure
def three(trace: Trace, times: int = 2) -> float:
    return 3.0 * times
"""
EVALUATE = """
import pickle, sys
from lavendersim.measures import evaluate
print(evaluate(pickle.load(sys.stdin.buffer), None))
"""


def test_the_text_goes_along_to_other_processes(tmp_path: Path) -> None:
    (tmp_path / "measures.py").write_text(OWN)
    own = read_own(tmp_path / "measures.py")
    assert [*own.kinds] == ["three"]
    given = {"kind": "from_file", "function": "three", "sha256": own.sha256}
    spec = FromFile.model_validate({**given, "parameters": {"times": 4}})
    (tmp_path / "measures.py").unlink()
    done = subprocess.run(
        [sys.executable, "-c", EVALUATE],
        input=pickle.dumps(spec),
        capture_output=True,
        check=True,
    )
    assert float(done.stdout) == 12.0


def test_a_text_that_this_process_was_not_given_is_none() -> None:
    spec = FromFile.model_validate({"kind": "from_file", "function": "x", "sha256": "0" * 64})
    assert spec.source is None
