"""What of a cell an engine cannot do: each with the path of the key that asks for it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

from lavendersim.cell import CellConfig
from lavendersim.cell.choices import NO_MISTAKE
from lavendersim.cell.record import NONE
from lavendersim.cell.surface import PairedSurface
from lavendersim.engine.effects import BODY_KEYS, SCENE_KEYS, SURFACE_KEYS
from lavendersim.peers.catalogue import peer_of
from lavendersim.peers.declaration import Peer
from lavendersim.peers.mixing import RULES, Unmixable, values_by

Path = tuple[str | int, ...]


class Limit(NamedTuple):
    """One key that asks for what an engine cannot do."""

    path: Path
    sentence: str


def limits_of(config: CellConfig) -> list[Limit]:
    """Return what the engine of a cell cannot do; nothing for lavender's."""
    if config.engine is None:
        return []
    peer = peer_of(config.engine.name)
    return [
        Limit(path, f"{path[-1]}: {peer.title} {sentence}")
        for path, sentence in (
            *_of_bodies(config, peer),
            *_of_mixing(config, peer),
            *_of_scene(config, peer),
            *_of_run(config),
        )
    ]


def _of_bodies(config: CellConfig, peer: Peer) -> Iterator[tuple[Path, str]]:
    for name, body in config.scene.bodies.items():
        place: Path = ("scene", "bodies", name)
        parts = [part.shape for part in getattr(body.shape, "parts", ())]
        for shape in (body.shape, *parts):
            if shape.kind not in peer.shapes:
                has = ", ".join(sorted(peer.shapes))
                yield (*place, "shape"), f"has no {shape.kind} here; expected one of {has}"
                break
        for key in BODY_KEYS:
            if getattr(body, key.name) != key.default:
                yield (*place, key.name), f"has none here; expected it left out of {name}"
        surface = body.surface
        partners = surface.partners if isinstance(surface, PairedSurface) else ()
        for own in SURFACE_KEYS:
            written = [getattr(one, own.name) for one in (surface, *partners)]
            if (
                own.name in peer.surface_keys
                or own.name in _BESIDE
                or _unused(written, own.default)
            ):
                continue
            obeys = " and ".join(sorted(peer.surface_keys))
            sentence = f"does not obey it, of surfaces it does {obeys}"
            yield (*place, "surface", own.name), f"{sentence}; expected {own.default:g} ({name})"


def _of_mixing(config: CellConfig, peer: Peer) -> Iterator[tuple[Path, str]]:
    """Yield the coefficients that its own rule does not make of any values of two bodies."""
    from lavendersim.geometry.bodies import is_movable  # late: it loads numpy

    bodies = config.scene.bodies
    for key in peer.mixing:
        surfaces = [(one.surface, is_movable(one)) for one in bodies.values()]
        found = values_by(peer.mixing, key, surfaces)
        if not isinstance(found, Unmixable):
            continue
        a, b = (list(bodies)[one] for one in found.pair)
        own = b if is_movable(bodies[b]) else a
        yield (
            ("scene", "bodies", own, "surface", key),
            f"takes {RULES[peer.mixing[key]].words} of two bodies, and no values of bodies were "
            f"found that give {found.required:g} between {a} and {b} beside all other contacts; "
            "expected surfaces that differ less",
        )


# Of no use without another key of the same surface, which is refused or kept by itself.
_BESIDE = ("stribeck_velocity",)


def _unused(values: list[Any], default: float) -> bool:
    return all(value is None or value == default for value in values)


def _of_scene(config: CellConfig, peer: Peer) -> Iterator[tuple[Path, str]]:
    for key in SCENE_KEYS:
        if getattr(config.scene, key.name) != key.default:
            yield ("scene", key.name), "has none here; expected none"
    for number, force in enumerate(config.scene.forces):
        if not peer.forces:
            yield ("scene", "forces"), "has no forces here; expected none"
            break
        if not force.constant_at_centre:
            place: Path = ("scene", "forces")
            sentence = "has constant forces at the centre of mass alone, in world axes"
            yield place, f"{sentence}; force {number} is another"
    if all(body.fixed for body in config.scene.bodies.values()):  # a plane is
        yield ("scene", "bodies"), "has nothing to simulate: no body moves"


def _of_run(config: CellConfig) -> Iterator[tuple[Path, str]]:
    if config.planned_events:
        yield ("events",), "takes no events; expected none"
    if config.numerics.accuracy is not None:
        yield ("numerics", "accuracy"), "makes every step one timestep long; expected null"
    if config.effects.switches or config.effects.force:
        yield ("effects",), "has none of lavender's effects to switch; expected none"
    if config.study.mistake != NO_MISTAKE:
        yield ("study", "mistake"), "makes none of lavender's errors; expected none"
    if config.record.residuals != NONE:
        yield ("record", "residuals"), "reports no residuals of sweeps; expected none"
    if config.record.problems != NONE:
        yield ("record", "problems"), "reports no contact problems; expected none"
