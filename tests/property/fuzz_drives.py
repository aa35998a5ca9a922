"""What drives a drawn scene beside bodies: functions of time, forces, springs, events.

And what holds between two surfaces. Functions take the pen of `fuzz_scenes`, which draws numbers
and knows what the plan has.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from lavendersim.engine.effects.joint_models import JOINTS


def factor(pen: Any, duration: float, jumps: bool = True) -> dict[str, Any]:
    """Return a function of time of any kind; of a motion none that jumps."""
    kind = pen.one_of(("ramp", "sine", "table", *(("pulse",) if jumps else ())))
    begin = 0.7 * duration * pen.share()
    end = begin + duration * pen.share(0.01)
    if kind == "ramp":
        some = {"kind": kind, "rate": pen.signed(-1.0, 2.0), "from": begin}
        return some | ({"to": end} if pen.coin() else {})
    if kind == "pulse":
        return {"kind": kind, "from": begin, "to": end}
    if kind == "table":
        values = [pen.signed(-2.0, 1.0) for _ in range(pen.integer(2, 4))]
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
    if pen.coin():
        turn = {"turn": pen.some_vector(-2.0, 0.5), "factor": factor(pen, duration, jumps=False)}
        made.append(turn | ({"through": pen.vector(1.0)} if pen.coin() else {}))
    for _ in range(pen.integer(0 if made else 1, 2)):
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
    for _ in range(pen.integer(1, 2)):
        one = pen.one_of(movable)
        other = pen.one_of([name for name in bodies if name != one])
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
        if pen.coin():
            varying["point"] = pen.vector(pen.power(-3.0, 0.0))
        if pen.coin():
            varying["frame"] = "body"
        made.append(varying)
    return [
        {
            "body": pen.one_of(movable),
            "from": 0.5 * duration * pen.share(),
            "to": duration,
            "force": pen.some_vector(-3.0, 4.0),
            "torque": pen.vector(pen.power(-3.0, 3.0)),
            **own,
        }
        for own in made
    ]


def events(
    pen: Any, bodies: dict[str, Any], movable: list[str], scene: dict[str, Any], plan: Any
) -> Any:
    """Return sudden changes of bodies, removals, changes of the timestep, of gravity, of surfaces.

    Some happen when a state is come to. Bodies that forces act on, to the end, are not removed;
    those of joints are not moved.
    """
    busy = {one["body"] for one in scene["forces"]}
    joined = {name for one in scene["connections"].values() if one["kind"] in JOINTS
              for name in one["between"]}  # fmt: skip
    dt, duration = Fraction(plan["timestep"]), plan["duration"]
    made: list[dict[str, Any]] = []
    gone: dict[str, float] = {}
    for _ in range(pen.integer(0, 3)):
        at, kind = duration * pen.share(), pen.one_of((0, 1, 0, 1, *range(2, 9)))
        if kind == 0:
            factor_of_dt = pen.one_of((Fraction(1, 3), Fraction(1, 2), 2, 5))
            made.append({"at": at, "timestep": str(dt * factor_of_dt)})
            continue
        if kind == 1:
            free = [name for name in bodies if name not in busy and name not in gone]
            used = {event.get("body") for event in made}
            free = [name for name in free if name not in used]
            if free:
                gone[pen.one_of(free)] = at
                made.append({"at": at, "body": [*gone][-1], "remove": True})
            continue
        when = {"at": at} if pen.coin() else trigger(pen, bodies, movable)
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
        if kind in (4, 8):
            there = [name for name in there if name not in joined]
        if there:
            body = pen.one_of(there)
            made.append({**when, "body": body, **changes[kind]})
    return made


def trigger(pen: Any, bodies: dict[str, Any], movable: list[str]) -> dict[str, Any]:
    """Return a state of one body, or of two, that makes an event happen."""
    kind = pen.one_of(("touches", "leaves", "faster_than", "slower_than", "above"))
    body = pen.one_of(movable)
    if kind in ("touches", "leaves"):
        other = pen.one_of([name for name in bodies if name != body])
        return {"when": {kind: [body, other]}}
    if kind == "above":
        return {"when": {"body": body, "along": pen.some_vector(0.0, 0.0), kind: pen.share()}}
    return {"when": {"body": body, kind: pen.power(-2.0, 2.0)}}


def paired(pen: Any, bodies: dict[str, Any]) -> dict[str, Any]:
    """Name the surfaces of some bodies, and say what holds between two of them."""
    named = [name for name in bodies if pen.coin()][:2]
    between = pen.surface(1.0) if len(named) == 2 else {}
    if not between:
        return {}
    surfaces = {f"surface_{k}": bodies[name]["surface"] for k, name in enumerate(named)}
    for k, name in enumerate(named):
        bodies[name]["surface"] = f"surface_{k}"
    return {"surfaces": surfaces, "surface_pairs": {"both": {"between": [*surfaces], **between}}}


def set_in_motion(pen: Any, body: dict[str, Any], fastest: float) -> None:
    """Give what no other body moves its motion, in some scenes none.

    fastest: power of ten of the greatest angular velocity [rad/s].
    """
    driven = pen.one_of(("", "velocity", "motion"))
    if driven == "motion" and pen.has("prescribed_motion"):
        body |= {"kinematic": True, "motion": motion(pen, pen.duration)}
    elif driven and "kinematic" in pen.plan.effects and not pen.calm:
        body |= {"kinematic": True, "angular_velocity": pen.vector(pen.power(-2.0, fastest))}
        if pen.coin():
            body["velocity"] = pen.vector(pen.power(-2.0, 1.0))
