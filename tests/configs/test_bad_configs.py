"""Every bad config is refused with exactly the sentences a person should read, and at once.

A case is `bad/<section>/<case>.yaml` beside `<case>.expected`, one line per defect. Texts that no
text file can hold, or that are too long to read, are made here.
"""

from __future__ import annotations

import gc
import time
from pathlib import Path

import pytest

from lavendersim.errors import ConfigError
from lavendersim.experiment import load_experiment

BAD = Path(__file__).parent / "bad"
CASES = sorted(BAD.rglob("*.yaml"))
LONGEST = 5.0  # [s]; 100,000 values take half a second, and what grows as their square takes hours

FLOOR = "scene: {bodies: {floor: {shape: {kind: plane}}}}\nduration: 1\n"
NOT_UTF_8 = "byte 0xe9 is not UTF-8; save the file as UTF-8"
TOO_DEEP = "nested deeper than 32 levels"
ALIAS_BOMB = "a: &a [x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"{name}: &{name} [{', '.join([f'*{before}'] * 9)}]\n"
    for before, name in zip("abcdefgh", "bcdefghi", strict=True)
)
NO_ANCHORS = "anchors and aliases are not read; write the value out where it is used"

MADE: dict[str, tuple[bytes, tuple[str, ...]]] = {
    "not_utf_8": (b"question: caf\xe9\n", (f"1:14: {NOT_UTF_8}",)),
    "not_utf_8_behind_a_byte_order_mark": (
        "\ufeffa: é\nb: ".encode() + b"\xe9\n",
        (f"2:4: {NOT_UTF_8}",),
    ),
    "utf_16": ("a: 1\n".encode("utf-16"), ("1:1: the file is UTF-16; save it as UTF-8",)),
    "null_byte": (b"a: 1\nb: \x00\n", ("2:4: control character U+0000; remove it",)),
    "escape_sequence": (b"a: \x1b[31m\n", ("1:4: control character U+001B; remove it",)),
    "deep_lists": (b"a: " + b"[" * 100_000, (f"1:35: {TOO_DEEP}",)),
    "deep_lists_behind_another_defect": (
        "é: *x\nb: ".encode() + b"[" * 100_000,
        ("1:4: alias *x: there is no such anchor", f"2:35: {TOO_DEEP}"),
    ),
    "deep_mappings": (b"{a: " * 100_000, (f"1:129: {TOO_DEEP}",)),
    "deep_dashes": (b"- " * 100_000, (f"1:65: {TOO_DEEP}",)),
    "deep_keys": (b"? " * 100_000, (f"1:65: {TOO_DEEP}",)),
    "too_large": (
        b"# " + b"x" * (1 << 20),
        ("1:1: the file has 1048578 bytes; a config has at most 1 MiB",),
    ),
    "too_many_values": (
        b"a: [" + b"1," * 400_000 + b"]",
        ("1:199999: more than 100000 values in one file",),
    ),
    "alias_bomb": (
        ALIAS_BOMB.encode() + FLOOR.encode(),
        (
            *(
                f"{line}:{column}: {sentence}"
                for line, name in enumerate("abcdefghi", start=1)
                for column, sentence in (
                    (1, f'unknown key "{name}" in the experiment; {{hint}}'),
                    (4, f"anchor &{name}: {NO_ANCHORS}"),
                )
            ),
            "10:9: bodies: nothing can move here; expected at least one body that is not fixed",
        ),
    ),
    "thousands_of_defects": (
        FLOOR.encode() + b"".join(b"key_%d: 1\n" % number for number in range(5000)),
        (
            "1:9: bodies: nothing can move here; expected at least one body that is not fixed",
            *(
                f'{number + 3}:1: unknown key "key_{number}" in the experiment; {{hint}}'
                for number in range(198)
            ),
            "201:1: ... and 4802 more defects from here on",
        ),
    ),
}
TOP_KEYS = (
    "valid here: constants, scene, events, numerics, duration, record, effects, study, engine, "
    "engines, extends, question, expected, sweep, measure, expect, always, slow, reduced, figure, "
    "overhead, cost"
)


def refusal(path: Path) -> list[str]:
    """Return the messages a config is refused with, its folder left out."""
    with pytest.raises(ConfigError) as caught:
        load_experiment(path)
    assert all(defect.file == str(path) for defect in caught.value.defects)
    assert str(caught.value).splitlines() == [str(defect) for defect in caught.value.defects]
    assert caught.value.exit_code == 2
    return [str(defect._replace(file=path.name)) for defect in caught.value.defects]


def refusal_in_time(path: Path) -> list[str]:
    """Return the messages. Threads and garbage that other tests left here are not timed."""
    gc.disable()
    try:
        start = time.thread_time()
        messages = refusal(path)
        assert time.thread_time() - start < LONGEST
    finally:
        gc.enable()
    return messages


@pytest.mark.parametrize("path", CASES, ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_bad_config_is_refused_with_all_its_defects(path: Path) -> None:
    expected = path.with_suffix(".expected").read_text(encoding="utf-8").splitlines()
    assert refusal_in_time(path) == expected


@pytest.mark.parametrize("case", MADE)
def test_bad_bytes_are_refused_with_all_their_defects(case: str, tmp_path: Path) -> None:
    raw, expected = MADE[case]
    path = tmp_path / "made.yaml"
    path.write_bytes(raw)
    assert refusal_in_time(path) == [
        f"made.yaml:{line}".replace("{hint}", TOP_KEYS) for line in expected
    ]


def test_every_case_says_what_it_expects() -> None:
    assert len(CASES) >= 100
    assert {path.stem for path in CASES} == {path.stem for path in BAD.rglob("*.expected")}
    assert all(path.with_suffix(".expected").read_text(encoding="utf-8") for path in CASES)
