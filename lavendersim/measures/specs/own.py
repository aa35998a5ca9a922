"""The model of a measure that a Python file beside the config defines: see `measures.own_file`."""

from __future__ import annotations

from typing import Any, ClassVar, Final, Literal, Self

from pydantic import Field, PrivateAttr, model_validator

from lavendersim.measures.specs.base import Measure

FROM_FILE: Final = "from_file"
FILE: Final = "measures.py"  # beside a config


class FromFile(Measure):
    """What a function of a file `measures.py` returns.

    A run writes the kinds of such a file in this form; a config names them as it does all others.
    """

    # By digests the texts that this process may run: of files beside configs that it was asked to
    # run, and those named on the command line. Never what a run or a log has.
    SOURCES: ClassVar[dict[str, str]] = {}

    kind: Literal["from_file"]
    file: str = Field(default=FILE, min_length=1, description="from the folder of the config")
    function: str = Field(min_length=1, description="the kind that the file registers")
    sha256: str = Field(min_length=1, description="of the file's bytes, in hexadecimal digits")
    meaning: str = Field(default="", description="the first sentence of the function's docstring")
    parameters: dict[str, Any] = Field(default={}, description="what the function is called with")

    _source: str | None = PrivateAttr(default=None)  # goes along to other processes

    @model_validator(mode="after")
    def _with_source(self) -> Self:
        self._source = self.SOURCES.get(self.sha256)
        return self

    @property
    def source(self) -> str | None:
        """The text of the file; None where it is that of a run, and nobody has named the file."""
        return self._source or self.SOURCES.get(self.sha256)
