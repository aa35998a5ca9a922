"""How two surfaces mix: in either order, and to what a contact of two equal ones has."""

from __future__ import annotations

import pytest

from lavendersim.engine.effects import BODY_KEYS, SURFACE_KEYS, keys

PAIRS = [(0.0, 0.0), (0.0, 0.4), (0.2, 0.8), (0.5, 0.5)]


@pytest.mark.parametrize(
    ("mix", "expected"),
    [
        (keys.larger, (0.0, 0.4, 0.8, 0.5)),
        (keys.smaller_above_zero, (0.0, 0.4, 0.2, 0.5)),
        (keys.in_series, (0.0, 0.4, 1.0, 1.0)),
        (keys.geometric_mean, (0.0, 0.0, 0.4, 0.5)),
    ],
)
def test_mixtures(mix, expected) -> None:
    for (one, other), value in zip(PAIRS, expected, strict=True):
        assert mix(one, other) == pytest.approx(value, abs=1e-15)
        assert mix(other, one) == mix(one, other)


@pytest.mark.parametrize("key", SURFACE_KEYS, ids=lambda key: key.name)
def test_a_surface_that_says_nothing_changes_nothing_and_the_meaning_leaves_out_the_mixing(
    key,
) -> None:
    assert key.mix(key.default, key.default) == key.default
    assert key.meaning
    assert key.doc.startswith(key.meaning)


def test_values_have_no_direction_unless_a_key_says_so() -> None:
    assert keys.as_written(3.0, None) == 3.0
    turned = [key for key in BODY_KEYS if key.resolve is not keys.as_written]
    assert [key for key in turned if key.default == (0.0, 0.0, 0.0)]


def test_the_last_clause_of_a_line_is_how_pairs_mix() -> None:
    def key(doc: str):
        return keys.SurfaceKey(name="k", type=float, default=0.0, doc=doc, mix=keys.larger)

    assert key("[m] a; b; a pair takes the larger").meaning == "[m] a; b"
    assert key("[m] a").meaning == "[m] a"
