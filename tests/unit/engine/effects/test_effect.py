"""An effect says of itself what it brings to each record, by the engine it is in."""

from __future__ import annotations

import pytest

from lavendersim.engine.effects import EFFECTS
from lavendersim.engine.effects.decision import Decision
from lavendersim.engine.effects.effect import (
    CHAINED,
    Column,
    Effect,
    Fields,
    Hooks,
    hook_names,
    kernel,
)
from lavendersim.engine.spec import Spec


def sample() -> Effect:
    return Effect(
        name="sample",
        decide=lambda facts: Decision(True, "always"),
        per="contact",
        fields=Fields(
            body=[("heat", "f8")],
            contact=[("own", "f8"), ("shared", "f8")],
            contact_with=lambda spec: (
                [("shared", "f8"), ("more", "f8")] if spec.has("other") else []
            ),
        ),
        contact_columns=(
            Column("always", "f8", "what is always there", "N"),
            Column("at_times", "i8", "what is there", when=lambda spec: spec.has("other")),
        ),
        step_columns=(Column("sum", "f8", "a sum", "J"),),
    )


@pytest.mark.parametrize(
    ("spec", "contact", "row"),
    [
        (None, ["own", "shared"], ["always"]),
        (Spec(), ["own", "shared"], ["always"]),
        (Spec(effects=("other",)), ["own", "shared", "more"], ["always", "at_times"]),
    ],
)
def test_columns_are_listed_once_by_record_and_none_of_records_without(spec, contact, row) -> None:
    assert sample().columns_by_record(spec) == {
        "body": ["heat"],
        "contact": contact,
        "contact_row": row,
        "step_row": ["sum"],
    }


def test_a_meaning_has_its_unit_behind_it() -> None:
    assert Column("f", "f8", "a force", "N").text == "a force [N]"
    assert Column("n", "i8", "a count").text == "a count"


def test_hooks_that_chain_are_hooks_and_others_have_one_effect_each() -> None:
    assert set(CHAINED) < set(hook_names())
    single = set(hook_names()) - set(CHAINED)
    for name in single:
        makers = [effect for effect in EFFECTS if getattr(effect.hooks, name)]
        assert len(makers) == 1, name
    assert all(getattr(Hooks(), name) is None for name in hook_names())


def test_a_kernel_computes_what_its_function_does() -> None:
    def half(x):
        return 0.5 * x

    assert kernel(half, Spec())(3.0) == 1.5
