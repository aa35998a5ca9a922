"""Row terms: what contacts' rows are made of in an engine, by the declarations of its effects."""

from __future__ import annotations

from dataclasses import fields
from functools import cache
from typing import Any

from .effects import effects_of
from .effects.effect import kernel
from .spec import Spec
from .terms import RowTerms


@cache
def row_terms(spec: Spec) -> RowTerms:
    """Return the terms that effects of an engine declare; without friction rows are of a normal."""
    rows = [effect.row for effect in effects_of(spec)]
    terms = {term.name: any(getattr(row, term.name) for row in rows) for term in fields(RowTerms)}
    return RowTerms(**terms | {"frictionless": terms["frictionless"] or not terms["frictional"]})


def make_acts(spec: Spec) -> Any:
    """Return `kernel(contact) -> whether` it holds or pushes its bodies in this step.

    What is bilateral holds, whatever its impulse.
    """
    if not row_terms(spec).bilateral:

        def pushes(contact):
            return contact.lambda_n > 0.0

        return kernel(pushes, spec)

    def acts(contact):
        return contact.lambda_n > 0.0 or contact.bilateral == 1

    return kernel(acts, spec)


def make_is_soft(spec: Spec) -> Any:
    """Return `kernel(pair) -> whether` its contacts push as springs, of elastic engines."""
    curved = row_terms(spec).curved

    def is_soft(pair):
        soft = pair.compliance > 0.0
        if curved:
            soft = soft or pair.hertz_stiffness > 0.0
        return soft

    return kernel(is_soft, spec)


def by_friction(spec: Spec, make_frictionless: Any, make_frictional: Any) -> Any:
    """Return the kernel for the contacts that an engine has: of one kind, or by the contact.

    make_frictionless, make_frictional: (spec) -> kernel(contact, ...), with equal arguments.
    """
    terms = row_terms(spec)
    if not terms.frictional:
        return make_frictionless(spec)
    frictional = make_frictional(spec)
    if not terms.frictionless:
        return frictional
    frictionless = make_frictionless(spec)

    def either(contact, *others):
        if contact.frictional == 0:
            return frictionless(contact, *others)
        return frictional(contact, *others)

    either.__name__ = f"either_{frictionless.__name__}"  # as `lavender plan` lists them
    either.__qualname__ += f"_{frictionless.__name__}"
    return kernel(either, spec)
