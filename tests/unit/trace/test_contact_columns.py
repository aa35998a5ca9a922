"""Contacts packed by columns come back bit for bit, whatever the keys and the numbers are."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from lavendersim.trace.contact_columns import (
    ContactGroup,
    Packed,
    _order,
    column_form,
    message_of,
    pack,
    unpack,
)
from lavendersim.trace.predictors import Constants

FIELDS = [("body_a", "i8"), ("body_b", "i8"), ("feature", "i8"), ("x", "f8"), ("flags", "i8")]
NAMES = tuple(name for name, _ in FIELDS)


def contacts(count: int, seed: int, keys: int) -> np.ndarray:
    """Return contacts of so many different keys at most; numbers of every bit pattern."""
    random = np.random.default_rng(seed)
    rows = np.zeros(count, FIELDS)
    for name in ("body_a", "body_b", "feature"):
        rows[name] = random.integers(-keys, keys + 1, count)
    for name in ("x", "flags"):
        rows[name] = random.integers(-(2**63), 2**63 - 1, count).view(rows.dtype[name])
    return rows


def returned(rows: np.ndarray, names: tuple[str, ...]) -> np.ndarray:
    table = np.zeros(len(rows), rows.dtype)
    unpack(pack([rows], names, Constants()), names, table)
    return table


@pytest.mark.parametrize("keys", [0, 1, 3, 2**62])
@pytest.mark.parametrize("count", [0, 1, 2, 7, 500])
def test_packed_contacts_return(count: int, keys: int) -> None:
    rows = contacts(count, count, keys)
    assert returned(rows, NAMES).tobytes() == rows.tobytes()


@pytest.mark.parametrize("parts", [2, 3, 7])
def test_contacts_in_parts_are_packed_as_in_one(parts: int) -> None:
    """However steps came in: cut anywhere, into empty parts, too."""
    rows = contacts(500, 5, 3)
    cuts = np.sort(np.random.default_rng(parts).integers(0, 501, parts - 1))
    cuts[0] = 0
    split = pack(np.split(rows, cuts), NAMES, Constants())
    assert [bytes(one) for one in split] == [bytes(one) for one in pack([rows], NAMES, Constants())]


def test_contacts_without_a_key_return() -> None:
    rows = contacts(20, 1, 3)[["x", "flags"]].copy()
    plain = np.zeros(20, [("x", "f8"), ("flags", "i8")])
    plain["x"], plain["flags"] = rows["x"], rows["flags"]
    assert returned(plain, ("x", "flags")).tobytes() == plain.tobytes()


def test_what_persists_is_zero_but_for_its_first() -> None:
    """Two contacts that do not change over ten steps: of eighteen rows every bit is 0."""
    rows = np.zeros(20, FIELDS)
    rows["body_b"] = np.tile([1, 2], 10)
    rows["x"] = np.tile([0.1, -7.0], 10)
    planes = np.frombuffer(pack([rows], NAMES, Constants()).planes, np.uint8).reshape(8, 2, 20)
    of_x = planes[:, 0]
    assert (of_x[:, [*range(1, 10), *range(11, 20)]] == 0).all()
    for place, number in ((0, 0.1), (10, -7.0)):
        assert of_x[::-1, place].tobytes() == np.float64(number).tobytes()  # the heaviest first


def test_a_log_of_an_older_version_has_its_bits_xor() -> None:
    """Without predictors planes are xors with the row before: of 3, 5, 6 are 3, 6, 3."""
    rows = np.zeros(3, FIELDS)
    planes = np.zeros((8, 2, 3), np.uint8)
    planes[7, 1] = [3, 3 ^ 5, 5 ^ 6]
    unpack(Packed(bytes(3 * 3 * 8), planes.tobytes()), NAMES, rows)
    assert rows["flags"].tolist() == [3, 5, 6]
    assert (rows["x"] == 0.0).all()


@pytest.mark.parametrize("predictor", [3, 4, 5, 6, 7, 8, 255])
def test_a_predictor_that_a_column_cannot_have_is_refused(predictor: int) -> None:
    rows = contacts(10, 2, 3)
    packed = pack([rows], NAMES, Constants())._replace(predictors=bytes([predictor, 0]))
    with pytest.raises(
        ValueError, match=f"column x has predictor {predictor}, none of this version"
    ):
        unpack(packed, NAMES, rows)
    with pytest.raises(ValueError, match="zip"):
        unpack(packed._replace(predictors=b"\0"), NAMES, rows)


def test_planes_of_another_length_are_refused() -> None:
    rows = contacts(10, 2, 3)
    packed = pack([rows], NAMES, Constants())
    with pytest.raises(ValueError, match="reshape"):
        unpack(packed._replace(planes=packed.planes[:-1]), NAMES, np.zeros(10, rows.dtype))
    with pytest.raises(ValueError, match="reshape"):
        unpack(packed, NAMES, np.zeros(9, rows.dtype))


@pytest.mark.parametrize("largest", [0, 1, 5, 2**20, 2**21, 2**62, 2**63 - 1])
def test_keys_are_ordered_one_by_one_whatever_their_size(largest: int) -> None:
    """As Python sorts tuples; keys of 2^21 and more each do not fit into one number of 64 bits."""
    random = np.random.default_rng(largest % 1000)
    keys = random.integers(-largest, largest, (3, 300), np.int64, endpoint=True)
    keys = np.concatenate([keys, keys[:, ::2], [[-largest], [largest], [-largest]]], axis=1)
    rows = list(zip(*keys.tolist(), strict=True))
    order, persists = _order(keys)
    assert order.tolist() == sorted(range(len(rows)), key=lambda row: (rows[row], row))
    again = [rows[one] == rows[other] for one, other in itertools.pairwise(order)]
    assert persists.tolist() == [False, *again]


def test_equal_contacts_are_equal_messages() -> None:
    rows = contacts(100, 3, 4)
    steps = np.arange(10)
    group = ContactGroup(steps, steps * 4_166_666, np.full(10, 10), [rows])
    form = column_form(rows.dtype)
    assert b"".join(message_of(group, form, Constants())) == b"".join(
        message_of(group, form, Constants())
    )


def test_a_column_of_another_kind_is_refused() -> None:
    with pytest.raises(TypeError, match="contact column 'x' is float32; float64 or int64 needed"):
        column_form(np.dtype([("x", "f4")]))
