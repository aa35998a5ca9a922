"""Studies of peers: runs that belong together, what is timed, how they are judged."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from itertools import product
from typing import Final, NamedTuple

from . import errors, scenes
from .description import Scene, Sphere
from .errors import Track

Measures = dict[str, float | bool]

COARSE, FINE = Fraction(1, 60), Fraction(1, 240)  # timesteps of the drop [s]
SIXTEENTHS: Final = [Fraction(k, scenes.PHASES) for k in range(scenes.PHASES)]
RESTITUTIONS: Final = (0.5, 0.8, 1.0)
# Velocity and spin of a thrown ball, by the measure that its error is.
THROWS: Final = {
    "slides_m_s": ((6.0, 0.0, -3.0), (0.0, 0.0, 0.0)),
    "sticks_m_s": ((1.0, 0.5, -3.0), (5.0, -10.0, 0.0)),
    "comes_back_m_s": ((1.0, 0.0, -3.0), (0.0, -60.0, 0.0)),
}
QUARTERS: Final = [Fraction(2 * k + 1, 8) for k in range(4)]  # of a step: phases of an impact
IMPACTS: Final = [name for name in (*THROWS, "rod_m_s") for _ in QUARTERS]
BOUNCES: Final = 100


class Study(NamedTuple):
    """A row of the table."""

    runs: tuple[Scene, ...]
    judge: Callable[[list[Track]], Measures]
    every_step: bool = False  # states are read after every step, not a few times a second
    timed: int = 0  # which run is timed


def _stays(tracks: list[Track]) -> Measures:
    return {
        "drift_m": max(errors.drift(track) for track in tracks),
        "overlap_m": max(errors.overlap(track) for track in tracks),
    }


def _stands(tracks: list[Track]) -> Measures:
    return {"stands": all(errors.stands(track) for track in tracks)} | _stays(tracks)


def _settles(tracks: list[Track]) -> Measures:
    (track,) = tracks
    return {
        "overlap_m": errors.overlap(track),
        "height_m": float(track.poses[-1, :, 2].mean()),
    }


def _drops(tracks: list[Track]) -> Measures:
    """Worst of 16 phases for every restitution and timestep."""
    worst: Measures = {}
    for track in tracks:
        rate = round(1 / track.scene.timestep)
        name = f"apex_e{track.scene.restitution:g}_{rate}Hz"
        worst[name] = max(float(worst.get(name, 0.0)), errors.apex_error(track))
    return worst


def _slopes(tracks: list[Track]) -> Measures:
    """Effective friction of the runs that slide, creep of those that should not."""
    sliding, holding = tracks[: scenes.PHASES], tracks[scenes.PHASES :]
    found = [errors.effective_friction(track) for track in sliding]
    return {
        "friction_least": min(found),
        "friction_greatest": max(found),
        "creep_m_s": max(errors.creep(track) for track in holding),
    }


def _bounces(tracks: list[Track]) -> Measures:
    return {"energy_drift": errors.bounce_drift(tracks[0], BOUNCES)}


def _bullets(tracks: list[Track]) -> Measures:
    return {"tunnelled_of_64": sum(errors.tunnelled(track) for track in tracks)}


def _rotation(tracks: list[Track]) -> Measures:
    found = errors.free_rotation(tracks[0])
    return {
        "energy_drift": found.energy,
        "momentum_drift": found.momentum,
        "rate_error": found.rates,
    }


def _impacts(tracks: list[Track]) -> Measures:
    found: Measures = {}
    for name, track in zip(IMPACTS, tracks, strict=True):
        if name.startswith("rod"):
            exact = errors.after_end_impact(track.scene, scenes.ROD_LEAN)
        else:
            exact = errors.after_oblique_impact(track.scene)
        worst = max(errors.velocity_error(track, exact), float(found.get(name, 0.0)))
        found[name] = worst
    found["energy_gain"] = max(errors.kinetic_gain(track) for track in tracks)
    return found


def _all() -> dict[str, Study]:
    drops = tuple(
        scenes.drop(e, phase, timestep)
        for timestep, e, phase in product((FINE, COARSE), RESTITUTIONS, SIXTEENTHS)
    )
    slopes = [scenes.incline(1.2, angle) for angle in scenes.azimuths()]
    slopes += [scenes.incline(0.98, angle) for angle in scenes.azimuths()]
    throws = [scenes.thrown(*start, phase) for start in THROWS.values() for phase in QUARTERS]
    rods = [scenes.rod_end(phase) for phase in QUARTERS]
    return {
        "drop": Study(drops, _drops, every_step=True),
        "rest": Study((scenes.rest(scenes.CUBE), scenes.rest(Sphere(0.1))), _stays),
        "stack_6": Study((scenes.tower(6, 5.0),), _stands),
        "heavy_100": Study((scenes.heavy_on_light(100.0),), _stands),
        "heavy_10000": Study((scenes.heavy_on_light(10_000.0),), _stands),
        "tower_30": Study((scenes.tower(30, 10.0),), _stands),
        "tower_100": Study((scenes.tower(100, 5.0),), _stands),
        "pyramid_210": Study((scenes.pyramid(20),), _stands),
        "pile_1000": Study((scenes.pile(1000),), _settles),
        "incline": Study(tuple(slopes), _slopes),
        "bounces_100": Study((scenes.bounces(BOUNCES),), _bounces, every_step=True),
        "bullet": Study(
            tuple(scenes.bullet(Fraction(k, 64)) for k in range(64)), _bullets, every_step=True
        ),
        "free_rotation": Study((scenes.free_rotation(),), _rotation, every_step=True),
        "impacts": Study((*throws, *rods), _impacts),
    }


STUDIES: Final = _all()


def tiny() -> Study:
    """Return a study of a twentieth of a second, to see that the harness works."""
    return Study((scenes.rest(Sphere(0.1), 0.05),), _stays)
