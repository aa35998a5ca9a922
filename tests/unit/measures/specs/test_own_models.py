"""The source of a measure of a file: what this process may run, and nothing else."""

from __future__ import annotations

import pickle

import pytest
from pydantic import ValidationError

from lavendersim.measures.specs.own import FromFile

GIVEN = {"kind": "from_file", "function": "peak"}


@pytest.fixture
def known(monkeypatch: pytest.MonkeyPatch) -> dict[str, str]:
    sources: dict[str, str] = {}
    monkeypatch.setattr(FromFile, "SOURCES", sources)
    return sources


def test_a_text_is_found_by_its_digest_also_where_it_comes_later(known: dict[str, str]) -> None:
    spec = FromFile.model_validate({**GIVEN, "sha256": "ab"})
    assert spec.source is None
    known["cd"] = "another"
    assert spec.source is None
    known["ab"] = "text"
    assert spec.source == "text"


def test_the_text_goes_along_to_a_process_that_knows_none(known: dict[str, str]) -> None:
    known["ab"] = "text"
    spec = FromFile.model_validate({**GIVEN, "sha256": "ab"})
    sent = pickle.dumps(spec)
    known.clear()
    assert pickle.loads(sent).source == "text"


def test_the_text_is_no_part_of_what_is_written(known: dict[str, str]) -> None:
    """A run writes the digest: a run or a log can never bring code along."""
    known["ab"] = "text"
    spec = FromFile.model_validate({**GIVEN, "sha256": "ab", "parameters": {"above": 2.0}})
    written = spec.model_dump(exclude_defaults=True)
    assert written == {**GIVEN, "sha256": "ab", "parameters": {"above": 2.0}}
    for empty in ("function", "sha256"):
        with pytest.raises(ValidationError):
            FromFile.model_validate({**GIVEN, "sha256": "ab", empty: ""})
