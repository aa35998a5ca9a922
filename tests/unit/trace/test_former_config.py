"""Configs of older logs: plain YAML within limits, whatever they would grow to."""

from __future__ import annotations

import pytest

from lavendersim.trace.former_config import MOST_LEVELS, former_config


def test_a_mapping_of_plain_values() -> None:
    assert former_config(b"a: {b: [1, 2.5, text]}\n") == {"a": {"b": [1, 2.5, "text"]}}


def test_an_alias_is_the_value_that_it_names() -> None:
    assert former_config(b"a: &one {b: 1}\nc: *one\n") == {"a": {"b": 1}, "c": {"b": 1}}


@pytest.mark.parametrize("text", [b"[1, 2]", b"text", b"", b"a: !!python/name:os.system", b"a: ["])
def test_what_is_no_mapping_of_plain_values(text: bytes) -> None:
    with pytest.raises(ValueError, match=r"no mapping|no YAML"):
        former_config(text)


def test_brackets_as_deep_as_may_be_and_one_deeper() -> None:
    def nested(levels: int) -> bytes:
        return b"a: " + b"[" * (levels - 1) + b"]" * (levels - 1)

    former_config(nested(MOST_LEVELS))
    with pytest.raises(ValueError, match="nested deeper than 64 levels"):
        former_config(nested(MOST_LEVELS + 1))
    with pytest.raises(ValueError, match=r"nested deeper|no YAML"):  # libyaml has a limit, too
        former_config(nested(100_000))


def test_nine_aliases_of_a_billion_values_and_one_of_itself_are_refused() -> None:
    lines = ["a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]"]
    lines += [f"a{k}: &a{k} [{', '.join([f'*a{k - 1}'] * 10)}]" for k in range(1, 9)]
    with pytest.raises(ValueError, match="at most 1000000 values"):
        former_config("\n".join(lines).encode())
    with pytest.raises(ValueError, match="at most 1000000 values"):
        former_config(b"a: &own [*own]")
