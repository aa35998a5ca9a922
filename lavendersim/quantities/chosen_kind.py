"""A value of one of several kinds: its key `kind` chooses the model that it is read as.

`ByKind` is pydantic's discriminator with an error that lists the kinds. `one_of` makes ready only
what a file names: pydantic makes a validator of every model that a value could be, which takes
longer than to read most files.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cached_property
from typing import Annotated, Any, Final, Union, get_args

from pydantic import (
    BaseModel,
    Discriminator,
    GetCoreSchemaHandler,
    GetJsonSchemaHandler,
    Tag,
    TypeAdapter,
    ValidationInfo,
)
from pydantic_core import PydanticCustomError, SchemaValidator, core_schema

TAG: Final = "kind"
NO_KIND: Final = "no_kind"  # type of the error, whose context has `kinds`
_MESSAGE: Final = "expected one of {kinds}"


def kinds(model: type[BaseModel]) -> tuple[str, ...]:
    """Return the values of `kind` that choose this model."""
    info = model.model_fields.get(TAG)
    return get_args(info.annotation) if info is not None else ()


def _kind_of(value: Any) -> str | None:
    kind = value.get(TAG) if isinstance(value, Mapping) else getattr(value, TAG, None)
    return kind if isinstance(kind, str) else None


def _tagged(members: Iterable[type[BaseModel]]) -> Any:
    by_kind = {kind: model for model in members for kind in kinds(model)}
    named = tuple(Annotated[model, Tag(kind)] for kind, model in by_kind.items())
    discriminator = Discriminator(
        _kind_of,
        custom_error_type=NO_KIND,
        custom_error_message=_MESSAGE,
        custom_error_context={"kinds": ", ".join(by_kind)},
    )
    return Annotated[Union[named], discriminator]  # noqa: UP007


class ByKind:
    """Annotation of a union of models, of which `kind` chooses one."""

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> Any:
        """Return what validates a value."""
        return handler.generate_schema(_tagged(get_args(source)))


class ChosenKind:
    """Annotation of the union of models that have these kinds; each is made ready when named."""

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
        return TypeAdapter(_tagged(self._kinds.values()))

    def _validated(self, value: Any, info: ValidationInfo) -> Any:
        kind = _kind_of(value)
        if kind is None or kind not in self._kinds:
            listed = {"kinds": ", ".join(self._kinds)}
            raise PydanticCustomError(NO_KIND, _MESSAGE, listed)
        if kind not in self._ready:
            model = self._kinds[kind]
            model.model_rebuild()
            # With the tag in the place of an error, as it has among all kinds.
            one = core_schema.tagged_union_schema({kind: model.__pydantic_core_schema__}, TAG)
            self._ready[kind] = SchemaValidator(one)
        return self._ready[kind].validate_python(value, context=info.context)


def one_of(kinds: Mapping[str, type[BaseModel]]) -> Any:
    """Return the type of a value that is of one of these kinds."""
    return Annotated[Union[tuple(kinds.values())], ChosenKind(kinds)]  # noqa: UP007
