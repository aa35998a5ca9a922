"""Parts are found again by their keys, in the process and on disk, with all that they call."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from llvmlite.binding import Linkage, parse_assembly

from lavendersim.engine import kernel_parts
from lavendersim.engine.compile import Kernel, inner
from lavendersim.engine.kernel_parts import (
    OBJECT,
    PART,
    KernelPart,
    PartStore,
    key_of,
    merged_into,
    separate_in,
    symbol_of,
    with_called,
)

pytestmark = pytest.mark.skipif(Kernel is None, reason="this numba compiles kernels whole")


def part(name: str, *called: KernelPart, separate: bool = False, key: str = "", **how: Any) -> Any:
    return KernelPart(
        name, how.get("returns"), how.get("bitcode", b""), called, key or name, False,
        separate=separate,
    )  # fmt: skip


@pytest.fixture
def kept(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """The directory that parts are kept in."""
    monkeypatch.setattr(kernel_parts.kernel_store, "directory", lambda: (tmp_path, None))
    return tmp_path


def names(parts: Any) -> list[str]:
    return [one.symbol for one in parts]


def test_what_parts_call_comes_once_and_by_their_code_alone() -> None:
    """Depth first, each symbol once, in whatever process it was compiled."""
    low, other = part("low"), part("low")
    left, right = part("left", low), part("right", other, low)
    top = part("top", left, right)
    assert names(with_called([top])) == ["top", "left", "low", "right"]
    assert names(with_called([right, top])) == ["right", "low", "top", "left"]
    assert names(with_called([])) == []
    loop = part("loop")
    loop.called = (loop,)
    assert names(with_called([loop])) == ["loop"]


def test_separate_parts_are_called_and_what_they_call_is_merged_into_them_alone() -> None:
    deep = part("deep")
    apart = part("apart", deep, separate=True)
    top = part("top", apart, part("merged"))
    assert names(merged_into([top])) == ["top", "apart", "merged"]
    assert names(separate_in([top])) == ["apart"]
    below = part("below", part("again", separate=True), separate=True)
    assert names(separate_in([below])) == ["below", "again"]


def test_only_what_can_be_kept_is_separate() -> None:
    assert part("one", separate=True).separate
    assert not KernelPart("one", None, b"", (), "", False, separate=True).separate
    assert not part("one").separate


def test_a_part_is_found_in_the_process_and_by_another_with_what_it_calls(kept: Path) -> None:
    low = part("low", key="a" * 32, bitcode=b"low code")
    top = part("top", low, key="b" * 32, bitcode=b"top code", separate=True)
    first = PartStore()
    assert first.find(top.key) is None
    assert first.alone
    for one in (low, top):
        first.keep(one)
    first.begin(False)
    assert first.find(top.key) is top
    assert not first.alone
    second = PartStore()
    found = second.find(top.key)
    assert found is not None
    assert (found.symbol, found.bitcode, found.key) == ("top", b"top code", top.key)
    assert (found.separate, found.raises) == (True, False)
    (called,) = found.called
    assert called.bitcode == b"low code"
    assert second.find(low.key) is called
    assert len(list(kept.glob(f"*{PART}"))) == 2


def test_a_part_whose_callee_is_gone_is_compiled_again(kept: Path) -> None:
    low, top = part("low", key="a" * 32), None
    top = part("top", low, key="b" * 32)
    store = PartStore()
    store.keep(low)
    store.keep(top)
    (path,) = kept.glob(f"*{low.key}{PART}")
    path.unlink()
    assert PartStore().find(top.key) is None


def test_anew_nothing_is_taken_that_was_there_before(kept: Path) -> None:
    """But for what is compiled since."""
    old, new = part("old", key="a" * 32), part("new", key="c" * 32)
    store = PartStore()
    store.keep(old)
    store.keep_code(old.key, "old code")
    store.begin(anew=True)
    assert store.find(old.key) is None
    assert store.code(old.key) is None
    store.keep(new)
    store.keep_code(new.key, "new code")
    assert store.find(new.key) is new
    assert store.code(new.key) == "new code"
    assert store.alone
    store.begin(anew=False)
    assert store.find(old.key) is old
    assert store.code(old.key) == "old code"


def test_object_code_is_kept_beside_its_part(kept: Path) -> None:
    one = part("one", key="a" * 32)
    PartStore().keep_code(one.key, {"code": 3})
    assert PartStore().code(one.key) == {"code": 3}
    assert [path.suffix for path in kept.iterdir()] == [OBJECT]
    assert PartStore().code("b" * 32) is None


def test_a_part_without_a_key_is_nowhere(kept: Path) -> None:
    store = PartStore()
    store.keep(KernelPart("one", None, b"", (), "", False))
    assert store.find("") is None
    assert list(kept.iterdir()) == []


def test_without_a_directory_parts_are_kept_in_the_process(
    kept: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(kernel_parts.kernel_store, "directory", lambda: (Path(), None))
    one, store = part("one", key="a" * 32), PartStore()
    store.keep(one)
    store.keep_code(one.key, 5)
    assert (store.find(one.key), store.code(one.key)) == (one, 5)
    assert PartStore().find(one.key) is None
    assert list(kept.iterdir()) == []


CODE = """
declare double @low(double)
define double @{name}(double %x) {{
  %y = {body}
  ret double %y
}}
"""


def bitcode_of(name: str, body: str) -> bytes:
    text = CODE.format(name=name, body=body)
    if name == "low":
        text = text.replace("declare double @low(double)\n", "")
    return bytes(parse_assembly(text).as_bitcode())


def test_a_part_that_numba_links_brings_what_it_calls_once() -> None:
    """Symbols of it may stand in several modules: each may be taken for the others."""
    low = part("low", bitcode=bitcode_of("low", "fadd double %x, %x"))
    left = part("left", low, bitcode=bitcode_of("left", "call double @low(double %x)"))
    top = part("top", left, low, bitcode=bitcode_of("top", "call double @low(double %x)"))
    module = top._get_module_for_linking()
    functions = {function.name: function for function in module.functions}
    assert set(functions) == {"top", "left", "low"}
    assert not any(function.is_declaration for function in functions.values())
    assert {function.linkage for function in functions.values()} == {Linkage.linkonce_odr}
    assert top._ensure_finalized() is None


def twice(x):
    return 2.0 * x


def thrice(x):
    return 3.0 * x


def test_a_key_follows_the_code_and_the_types() -> None:
    from numba import float64, int64

    keys = {
        key_of(inner(function), types)
        for function in (twice, thrice)
        for types in ((float64,), (int64,))
    }
    assert len(keys) == 4
    assert all(len(key) == 32 for key in keys)
    assert key_of(inner(twice), (float64,)) in keys

    table = {1: 2.0}

    def unknown(x):
        return table[x]

    assert key_of(inner(unknown), (float64,)) == ""


def test_a_symbol_is_readable_and_of_no_other_code() -> None:
    own = f"{__name__}.twice_"
    assert symbol_of(twice, "abc") == f"{own}abc"
    unnamed = {symbol_of(twice, "") for _ in range(3)}
    assert len(unnamed) == 3
    assert all(symbol.startswith(f"{own}unnamed") for symbol in unnamed)
    assert np.isfinite(twice(1.0))
