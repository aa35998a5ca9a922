"""Options of reading come back from the row they are written as, and a row without one is none."""

from __future__ import annotations

import json

import pytest

from lavendersim.config_options import ConfigOptions

OPTIONS = ConfigOptions(True, "jacobi", ("set duration=1", "sweep a=duration:[1]"), 4)


@pytest.mark.parametrize("options", [OPTIONS, ConfigOptions()])
def test_options_come_back_from_their_row_as_json(options: ConfigOptions) -> None:
    assert ConfigOptions.of_row(json.loads(json.dumps(options.row))) == options


@pytest.mark.parametrize("key", OPTIONS.row)
def test_a_row_without_one_of_them_is_refused(key: str) -> None:
    row = {name: value for name, value in OPTIONS.row.items() if name != key}
    with pytest.raises(KeyError, match=key):
        ConfigOptions.of_row(row)
