"""Step terms: what a step of an engine reckons with, by the declarations of its effects."""

from __future__ import annotations

from dataclasses import fields
from functools import cache

from .spec import Spec
from .terms import StepTerms


@cache
def step_terms(spec: Spec) -> StepTerms:
    """Return the terms that effects of an engine declare."""
    from .effects import effects_of  # their files ask for terms as well

    steps = [effect.step for effect in effects_of(spec)]
    return StepTerms(
        **{term.name: any(getattr(step, term.name) for step in steps) for term in fields(StepTerms)}
    )
