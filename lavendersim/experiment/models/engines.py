"""The keys `engine` and `engines`: which engine simulates a cell, and settings of engines.

engine: mujoco-stiff
engines: {mujoco: {iterations: 50}}
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

from pydantic import AfterValidator, Field, WithJsonSchema, create_model

from lavendersim.peers.catalogue import NAMES, PEERS, unknown
from lavendersim.peers.declaration import Peer
from lavendersim.quantities.model import ConfigModel
from lavendersim.quantities.quantity import sentence_error


def _known(name: str) -> str:
    if name not in NAMES:
        raise sentence_error(unknown(name))
    return name


EngineName = Annotated[
    str, AfterValidator(_known), WithJsonSchema({"type": "string", "enum": list(NAMES)})
]


def _settings_of(peer: Peer) -> type[ConfigModel]:
    fields: dict[str, Any] = {
        one.name: (one.type | None, Field(default=None, description=f"{one.doc}; none: its own"))
        for one in peer.settings
    }
    title = f"{peer.title.replace(' ', '')}Settings"
    made: type[ConfigModel] = create_model(title, __base__=ConfigModel, **fields)
    made.__doc__ = f"Settings of {peer.title}, for all its variants."
    return made


class SettingsOfEngines(ConfigModel):
    """Settings of other engines, instead of those that their variants have; a key an engine."""


_SECTIONS: Any = {
    name: (
        _settings_of(peer) | None,
        Field(default=None, description=f"{peer.title}: {', '.join(peer.variants)}"),
    )
    for name, peer in PEERS.items()
}
_MADE: Any = create_model("Engines", __base__=SettingsOfEngines, **_SECTIONS)
_MADE.__doc__ = SettingsOfEngines.__doc__

# Its fields are those of the catalogue, which no type checker knows.
if TYPE_CHECKING:
    Engines = SettingsOfEngines
else:
    Engines = _MADE
