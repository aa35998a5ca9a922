"""docs/measures.md has every table that the models and functions of the measures give."""

from __future__ import annotations

from typing import get_args

import pytest
from measure_tables import TABLES
from sources import ROOT

from lavendersim.measures.closed_forms import FORMS
from lavendersim.measures.registration import FUNCTIONS
from lavendersim.measures.registry import evaluate
from lavendersim.measures.specs.arithmetic import OfMeasures
from lavendersim.measures.specs.base import FormName
from lavendersim.measures.specs.catalogue import KINDS

DOCUMENT = ROOT / "docs/measures.md"


@pytest.mark.parametrize("name", TABLES)
def test_every_table_stands_in_the_document_once(name: str) -> None:
    assert DOCUMENT.read_text(encoding="utf-8").count(f"<!-- table of {name} -->\n") == 1


def test_every_kind_has_a_function_and_every_function_a_kind() -> None:
    assert callable(evaluate)  # importing it has registered the functions
    of_logs = {model for model in KINDS.values() if not issubclass(model, OfMeasures)}
    # Other packages have kinds of their own, tests among them.
    own = {model for model in FUNCTIONS if model.__module__.startswith("lavendersim.")}
    assert own == of_logs  # the others are of measures, and `derived` has them


def test_every_closed_form_can_be_named_in_a_config() -> None:
    assert set(get_args(FormName)) == set(FORMS)
