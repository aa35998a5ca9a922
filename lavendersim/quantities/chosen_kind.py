"""A value of one of many kinds, of which only those that a file names are made ready.

Pydantic makes a validator of every model that a value could be, which takes longer than to read
most files. Here the model is chosen by the key `kind` first. What is no known kind is given to all
of them, for pydantic's own message.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Annotated, Any, Final, Union

from pydantic import BaseModel, Field, GetJsonSchemaHandler, TypeAdapter, ValidationInfo
from pydantic_core import SchemaValidator, core_schema

TAG: Final = "kind"


class ChosenKind:
    """Annotation of the union of models that have these kinds."""

    def __init__(self, kinds: Mapping[str, type[BaseModel]]) -> None:
        self._kinds = kinds
        self._ready: dict[str, SchemaValidator] = {}

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        """Return what validates a value; the models are not looked at now."""
        return core_schema.with_info_plain_validator_function(self._validated)

    def __get_pydantic_json_schema__(self, schema: Any, handler: GetJsonSchemaHandler) -> Any:
        """Return the schema of all kinds."""
        return handler(self._all.core_schema)

    @cached_property
    def _all(self) -> TypeAdapter[Any]:
        return TypeAdapter(_union(self._kinds))

    def _validated(self, value: Any, info: ValidationInfo) -> Any:
        kind = value.get(TAG) if isinstance(value, Mapping) else getattr(value, TAG, None)
        if not isinstance(kind, str) or kind not in self._kinds:
            return self._all.validate_python(value, context=info.context)
        if kind not in self._ready:
            model = self._kinds[kind]
            model.model_rebuild()
            # With the tag in the place of an error, as it has among all kinds.
            one = core_schema.tagged_union_schema({kind: model.__pydantic_core_schema__}, TAG)
            self._ready[kind] = SchemaValidator(one)
        return self._ready[kind].validate_python(value, context=info.context)


def _union(kinds: Mapping[str, type[BaseModel]]) -> Any:
    return Annotated[Union[tuple(kinds.values())], Field(discriminator=TAG)]  # noqa: UP007


def one_of(kinds: Mapping[str, type[BaseModel]]) -> Any:
    """Return the type of a value that is of one of these kinds."""
    return Annotated[_union(kinds), ChosenKind(kinds)]
