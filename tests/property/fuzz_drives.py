"""What drives a drawn scene beside bodies: functions of time, forces, springs, ropes, events.

And what holds between two surfaces. Functions take the pen of `fuzz_scenes`, which draws numbers
and knows what the plan has.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from hypothesis import strategies as st


def factor(pen: Any, duration: float, jumps: bool = True) -> dict[str, Any]:
    """Return a function of time of any kind; of a motion none that jumps."""
    kind = pen.draw(st.sampled_from(("ramp", "sine", "table", *(("pulse",) if jumps else ()))))
    begin = 0.7 * duration * pen.share()
    end = begin + duration * pen.share(0.01)
    if kind == "ramp":
        some = {"kind": kind, "rate": pen.signed(-1.0, 2.0), "from": begin}
        return some | ({"to": end} if pen.draw(st.booleans()) else {})
    if kind == "pulse":
        return {"kind": kind, "from": begin, "to": end}
    if kind == "table":
        values = [pen.signed(-2.0, 1.0) for _ in range(pen.draw(st.integers(2, 4)))]
        times = [begin + k * (end - begin) for k in range(len(values))]
        return {"kind": kind, "times": times, "values": values}
    return {
        "kind": kind,
        "frequency": pen.power(-1.0, 3.0),
        "amplitude": pen.signed(-2.0, 1.0),
        "phase_degrees": 360.0 * pen.share(),
        "offset": pen.signed(-2.0, 0.0),
    }


def motion(pen: Any, duration: float) -> list[dict[str, Any]]:
    """Return where a kinematic body is over time: at most one turn, first, and displacements."""
    made: list[dict[str, Any]] = []
    if pen.draw(st.booleans()):
        turn = {"turn": pen.some_vector(-2.0, 0.5), "factor": factor(pen, duration, jumps=False)}
        made.append(turn | ({"through": pen.vector(1.0)} if pen.draw(st.booleans()) else {}))
    for _ in range(pen.draw(st.integers(0 if made else 1, 2))):
        way = pen.some_vector(-3.0, 0.0)
        made.append({"displacement": way, "factor": factor(pen, duration, jumps=False)})
    return made


def springs(pen: Any, bodies: dict[str, Any], movable: list[str]) -> list[dict[str, Any]]:
    """Return damped springs between centres, from soft to stiff beyond what a step resolves.

    At points of bodies those that no step resolves give energy where their bodies touch something.
    """
    if not pen.has("spring") or len(bodies) < 2:
        return []
    made = []
    for _ in range(pen.draw(st.integers(1, 2))):
        one = pen.draw(st.sampled_from(movable))
        other = pen.draw(st.sampled_from([name for name in bodies if name != one]))
        made.append(
            {
                "a": one,
                "b": other,
                "stiffness": pen.power(-1.0, 7.0),
                "damping": pen.power(-2.0, 3.0) * pen.share(),
                "rest_length": pen.share(),
            }
        )
    return made


def forces(pen: Any, movable: list[str], duration: float) -> list[dict[str, Any]]:
    """Return what pushes and twists for a while: constant or over time, at a point, in a frame."""
    made = []
    if pen.has("external_force"):
        made.append({})
    if pen.has("varying_force"):
        varying: dict[str, Any] = {"factor": factor(pen, duration)}
        if pen.draw(st.booleans()):
            varying["point"] = pen.vector(pen.power(-3.0, 0.0))
        if pen.draw(st.booleans()):
            varying["frame"] = "body"
        made.append(varying)
    return [
        {
            "body": pen.draw(st.sampled_from(movable)),
            "from": 0.5 * duration * pen.share(),
            "to": duration,
            "force": pen.some_vector(-3.0, 4.0),
            "torque": pen.vector(pen.power(-3.0, 3.0)),
            **own,
        }
        for own in made
    ]


def ropes(pen: Any, sizes: dict[str, float], movable: list[str]) -> dict[str, Any]:
    """Return ropes between points of bodies: taut as the run begins, slack, or too short."""
    if not pen.has("rope") or len(sizes) < 2:
        return {}
    made: dict[str, Any] = {}
    for k in range(pen.draw(st.integers(1, 2))):
        one = pen.draw(st.sampled_from(movable))
        other = pen.draw(st.sampled_from([name for name in sizes if name != one]))
        rope: dict[str, Any] = {
            "kind": "rope",
            "between": [one, other],
            "points": [pen.vector(0.5 * sizes[name]) for name in (one, other)],
        }
        if pen.draw(st.booleans()):
            rope["length"] = pen.power(-2.0, 2.0)
        if pen.has("restitution"):
            rope["restitution"] = pen.share()
        made[f"rope_{k}"] = rope
    return made


def events(pen: Any, bodies: dict[str, Any], movable: list[str], pushed: Any, plan: Any) -> Any:
    """Return sudden changes of bodies, removals, changes of the timestep, of gravity, of surfaces.

    Some happen when a state is come to. pushed: forces, which act to the end: their bodies are not
    removed.
    """
    busy = {one["body"] for one in pushed}
    dt, duration = Fraction(plan["timestep"]), plan["duration"]
    made: list[dict[str, Any]] = []
    gone: dict[str, float] = {}
    for _ in range(pen.draw(st.integers(0, 3))):
        at, kind = duration * pen.share(), pen.draw(st.sampled_from((0, 1, 0, 1, *range(2, 9))))
        if kind == 0:
            factor_of_dt = pen.draw(st.sampled_from((Fraction(1, 3), Fraction(1, 2), 2, 5)))
            made.append({"at": at, "timestep": str(dt * factor_of_dt)})
            continue
        if kind == 1:
            free = [name for name in bodies if name not in busy and name not in gone]
            used = {event.get("body") for event in made}
            free = [name for name in free if name not in used]
            if free:
                gone[pen.draw(st.sampled_from(free))] = at
                made.append({"at": at, "body": [*gone][-1], "remove": True})
            continue
        when = {"at": at} if pen.draw(st.booleans()) else trigger(pen, bodies, movable)
        if kind == 2:
            if pen.has("gravity"):
                made.append({**when, "gravity": pen.some_vector(-1.0, 2.0)})
            continue
        there = [name for name in movable if name not in gone]
        changes: dict[int, dict[str, Any]] = {
            3: {"scale_mass": pen.power(-3.0, 3.0)},
            4: {"teleport": pen.vector(1.0)},
            5: {"velocity": pen.vector(10.0), "contact_cache": "clear"},
            6: {"angular_velocity": pen.vector(10.0)},
            7: {"surface": pen.surface(1.0)},
            8: {"orientation": [1.0, *pen.vector(1.0)]},
        }
        if there:
            body = pen.draw(st.sampled_from(there))
            made.append({**when, "body": body, **changes[kind]})
    return made


def trigger(pen: Any, bodies: dict[str, Any], movable: list[str]) -> dict[str, Any]:
    """Return a state of one body, or of two, that makes an event happen."""
    kind = pen.draw(st.sampled_from(("touches", "leaves", "faster_than", "slower_than", "above")))
    body = pen.draw(st.sampled_from(movable))
    if kind in ("touches", "leaves"):
        other = pen.draw(st.sampled_from([name for name in bodies if name != body]))
        return {"when": {kind: [body, other]}}
    if kind == "above":
        return {"when": {"body": body, "along": pen.some_vector(0.0, 0.0), kind: pen.share()}}
    return {"when": {"body": body, kind: pen.power(-2.0, 2.0)}}


def paired(pen: Any, bodies: dict[str, Any]) -> dict[str, Any]:
    """Name the surfaces of some bodies, and say what holds between two of them."""
    named = [name for name in bodies if pen.draw(st.booleans())][:2]
    between = pen.surface(1.0) if len(named) == 2 else {}
    if not between:
        return {}
    surfaces = {f"surface_{k}": bodies[name]["surface"] for k, name in enumerate(named)}
    for k, name in enumerate(named):
        bodies[name]["surface"] = f"surface_{k}"
    return {"surfaces": surfaces, "surface_pairs": {"both": {"between": [*surfaces], **between}}}
