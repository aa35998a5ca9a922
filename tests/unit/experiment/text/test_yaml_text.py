"""A merged config as text is read back as the same values, types and ratios included."""

from __future__ import annotations

from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from lavendersim.experiment.text.parse import parse
from lavendersim.experiment.text.report import Report
from lavendersim.experiment.text.yaml_text import as_yaml
from lavendersim.quantities.scalars import resolve

# What YAML takes for something else when it stands without quotes; the rest is drawn.
TELLING = [
    "",
    "1",
    "1e-3",
    "012",
    "0x10",
    "1/480",
    "null",
    "True",
    "~",
    "- a",
    "a: b",
    "a #b",
    "[a",
]
TELLING += ["'", '"', "a\nb", "tab\t", " x", "x ", "\x85", "{}", "&a", "!b", "%c", "@d", "yes", "é"]
READABLE = st.characters(min_codepoint=32, max_codepoint=0x2FFFF).filter(
    lambda one: one.isprintable()
)
TEXTS = st.sampled_from(TELLING) | st.text(READABLE, max_size=100)
NUMBERS = st.sampled_from(["1/480", "-3/7", "1e-300", "0.1", "-0.0", "123456789012345678901"]).map(
    resolve
)
SCALARS = (
    st.none()
    | st.booleans()
    | st.integers(-(2**63), 2**63)
    | st.floats(allow_nan=False, allow_infinity=False)
    | NUMBERS
    | TEXTS
)
VALUES = st.recursive(
    SCALARS,
    lambda inner: (
        st.lists(inner, max_size=6).map(tuple) | st.dictionaries(TEXTS, inner, max_size=6)
    ),
    max_leaves=30,
)


def described(value: Any) -> Any:
    """Return a value with the type of each part, and the sign of zero."""
    if isinstance(value, dict):
        return [(key, described(one)) for key, one in value.items()]
    if isinstance(value, tuple):
        return tuple(described(one) for one in value)
    return type(value), repr(value)


@given(st.dictionaries(TEXTS, VALUES, min_size=1, max_size=6))
def test_what_is_written_is_read_back_as_it_was(data: dict[str, Any]) -> None:
    report = Report("")
    node = parse(as_yaml(data).encode(), report)
    assert report.defects == ()
    assert node is not None
    assert described(node.data) == described(data)
