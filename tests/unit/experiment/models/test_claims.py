"""Rules between claims: an operand stands above, names stand once, a control has one subject."""

from __future__ import annotations

import pytest

from tests.marked_config import assert_refused, config, refusals

HEIGHT = "{kind: apex_error, body: ball, above: floor}"


def with_claims(measures: str, *expectations: str, **sections: str) -> str:
    sections["measure"] = f"{{a: {HEIGHT}, b: {HEIGHT}{measures}}}"
    sections["expect"] = f"[{', '.join(expectations)}]"
    return config(**sections)


def test_a_measure_is_of_those_above_it() -> None:
    good = with_claims(", d: {kind: difference, measure: a, minus: b}")
    assert refusals(good) == []
    later = f", d: {{kind: difference, measure: a, minus: §later}}, later: {HEIGHT}"
    found = 'minus: expected a measure above "d", found "later"'
    assert_refused(with_claims(later), found)
    own = ", d: {kind: difference, measure: §d, minus: b}"
    assert_refused(with_claims(own), 'measure: expected a measure above "d", found "d"')


def test_a_name_of_two_expectations_is_refused_with_the_line_of_the_first() -> None:
    claim = "{name: low, measure: a, at_most: 1}"
    text = with_claims("", claim).replace(
        claim, claim + ",\n  {name: §low, measure: b, at_most: 1}"
    )
    assert_refused(text, 'name: "low" is the name of another expectation, line 4')


@pytest.mark.parametrize("fails", ["low", "completes", "diverges", "penetration"])
def test_a_control_may_name_a_claim_or_a_check(fails: str) -> None:
    control = f"{{name: control, fails: {fails}}}"
    claims = with_claims("", "{name: low, measure: a, at_most: 1}", control, always="{}")
    assert refusals(claims) == []


def test_a_control_of_nothing_and_of_two_things_is_refused() -> None:
    low = "{name: low, measure: a, at_most: 1}"
    assert_refused(
        with_claims("", low, "{name: control, fails: §lov}"),
        'fails: no expectation or check is called "lov"; did you mean "low"?',
    )
    named = "{name: penetration, measure: a, at_most: 1}"
    assert_refused(
        with_claims("", named, "{name: control, fails: §penetration}", always="{}"),
        'fails: "penetration" is an expectation and a check; rename the first',
    )
    off = "{penetration: none}"  # a check that is not made cannot fail
    found = refusals(with_claims("", "{name: control, fails: penetration}", always=off))
    assert len(found) == 1
    assert 'no expectation or check is called "penetration"' in found[0]
