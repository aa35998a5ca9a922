"""Step log: `/step`, the sums of every step: energy, momentum, residual, hash of the state.

What an effect adds to a step it logs itself: its `step_columns` and its hook `step_row`.
"""

from ..spec import Spec
from ..step_terms import step_terms
from .decision import Decision, Facts
from .effect import Column, Effect, Hooks, kernel


def decide(facts: Facts) -> Decision:
    """On when the run is logged."""
    if facts.record:
        return Decision(True, "the run is logged")
    return Decision(False, "nothing of the run is logged")


def _has_gjk(spec: Spec) -> bool:
    from ..collide.iteration_limits import has_gjk

    return has_gjk(spec)


def _has_epa(spec: Spec) -> bool:
    from ..collide.iteration_limits import has_epa

    return has_epa(spec)


def _has_ascent(spec: Spec) -> bool:
    from ..collide.iteration_limits import has_ascent

    return has_ascent(spec)


def make(spec: Spec, log_pose, loggers):
    """Return `kernel(bodies, velocities, params, counters, log)`, at the end of a step.

    log_pose: the kernel of `pose_log`; loggers: kernels (row, bodies, counters) of the effects that
    log more of a step. log: `memory.Log`, with room.
    """
    from ..compile import chain
    from ..rotation import inertia_times
    from . import has_hook, made_once

    rotation, tolerance = step_terms(spec).turns, spec.tolerance
    sleeps = has_hook(spec, "update_sleeping")
    speeds = 6 if rotation else 3  # vx vy vz, wx wy wz: the first words of a velocity record
    log_more = chain(loggers, spec)
    logs_velocity, log_velocity = made_once(spec, "log_velocity")
    gjk, epa, ascends = _has_gjk(spec), _has_epa(spec), _has_ascent(spec)

    def hash_into(state_hash, words, count):
        # FNV-1a over 64-bit words; -0.0 counts as 0.0, because no result may depend on it.
        for k in range(count):
            word = words[k]
            if word == 0x8000000000000000:
                word = word ^ word
            state_hash = (state_hash ^ word) * 0x100000001B3
        return state_hash

    hash_into = kernel(hash_into, spec)

    def log_bodies(bodies, velocities, row, pose, params):
        kinetic, potential = 0.0, 0.0
        px, py, pz = 0.0, 0.0, 0.0
        ax, ay, az = 0.0, 0.0, 0.0
        for i in range(pose.shape[0]):
            body, v = bodies[i], velocities[i]
            log_pose(body, pose[i])
            if logs_velocity:
                log_velocity(v, pose[i])
            inv_m = body.inv_m
            if sleeps:
                if body.asleep == 1:
                    inv_m = body.own_inv_m
            if inv_m > 0.0:
                m = 1.0 / inv_m
                kinetic += 0.5 * m * (v.vx * v.vx + v.vy * v.vy + v.vz * v.vz)
                potential -= m * (params.gx * body.x + params.gy * body.y + params.gz * body.z)
                mx, my, mz = m * v.vx, m * v.vy, m * v.vz
                px, py, pz = px + mx, py + my, pz + mz
                ax += body.y * mz - body.z * my
                ay += body.z * mx - body.x * mz
                az += body.x * my - body.y * mx
                if rotation:
                    lx, ly, lz = inertia_times(body, v.wx, v.wy, v.wz)
                    kinetic += 0.5 * (lx * v.wx + ly * v.wy + lz * v.wz)
                    ax, ay, az = ax + lx, ay + ly, az + lz
        row.kinetic_energy, row.potential_energy = kinetic, potential
        row.momentum_x, row.momentum_y, row.momentum_z = px, py, pz
        row.angular_momentum_x, row.angular_momentum_y, row.angular_momentum_z = ax, ay, az

    log_bodies = kernel(log_bodies, spec)

    def log_step(bodies, velocities, params, counters, log):
        poses = log.pose
        row = log.step[counters.step_rows]
        row.step = counters.step
        row.sweeps = counters.sweeps
        row.residual_contact = counters.residual_row
        if tolerance:
            row.not_converged = counters.not_converged
        if gjk:
            row.gjk_not_converged = counters.gjk_not_converged
        if epa:
            row.epa_not_converged = counters.epa_not_converged
        if ascends:
            row.ascent_not_converged = counters.ascent_not_converged
        row.residual = counters.residual
        log_bodies(bodies, velocities, row, poses[counters.step_rows], params)
        log_more(row, bodies, counters)
        pose_bits, velocity_bits = log.pose_bits, log.velocity_bits
        state_hash = 0xCBF29CE484222325 ^ row.step
        for i in range(poses.shape[1]):
            state_hash = hash_into(state_hash, pose_bits[counters.step_rows, i], 7)
            state_hash = hash_into(state_hash, velocity_bits[i], speeds)
            # What cannot turn hashes as what does not: the plan leaves no trace in the hash.
            for _ in range(speeds, 6):
                state_hash = state_hash * 0x100000001B3
        row.state_hash = state_hash
        counters.step_rows += 1
        counters.contact_rows += row.contact_count

    return kernel(log_step, spec)


EFFECT = Effect(
    name="step_log",
    decide=decide,
    per="body",
    step_columns=(
        Column("step", "i8", "index of the step; 0 is the initial state", number=1),
        Column("contact_count", "i8", "number of contacts", number=3),
        Column("sweeps", "i8", "solver sweeps done", number=4),
        Column("residual_contact", "i8", "row of the contact that has it; -1 none", number=6),
        Column(
            "total_normal_force",
            "f8",
            "sum of normal forces of what touches, each impulse / timestep",
            "N",
            number=7,
        ),
        Column("max_penetration", "f8", "deepest penetration", "m", number=8),
        Column(
            "residual", "f8", "largest residual over the contacts after the solve", "m/s", number=5
        ),
        Column("kinetic_energy", "f8", "kinetic energy of all movable bodies", "J", number=9),
        Column("potential_energy", "f8", "potential energy under gravity", "J", number=10),
        Column("momentum_x", "f8", "linear momentum, world x", "kg m/s", number=11),
        Column("momentum_y", "f8", "linear momentum, world y", "kg m/s", number=12),
        Column("momentum_z", "f8", "linear momentum, world z", "kg m/s", number=13),
        Column(
            "angular_momentum_x", "f8", "about the world origin, world x", "kg m^2/s", number=14
        ),
        Column(
            "angular_momentum_y", "f8", "about the world origin, world y", "kg m^2/s", number=15
        ),
        Column(
            "angular_momentum_z", "f8", "about the world origin, world z", "kg m^2/s", number=16
        ),
        Column(
            "state_hash",
            "u8",
            "hash of positions and velocities; equal states, equal hashes",
            number=17,
        ),
        Column(
            "not_converged",
            "i8",
            "1 when the residual stayed above the tolerance of the config",
            number=18,
            when=lambda spec: spec.tolerance,
        ),
        Column(
            "gjk_not_converged",
            "i8",
            "distances of convex bodies for which GJK took all its iterations",
            number=44,
            when=_has_gjk,
        ),
        Column(
            "epa_not_converged",
            "i8",
            "depths of convex bodies for which EPA ran out of vertices, or lost its mesh",
            number=45,
            when=_has_epa,
        ),
        Column(
            "ascent_not_converged",
            "i8",
            "depths of round bodies that the last of all rounds still improved",
            number=47,
            when=_has_ascent,
        ),
    ),
    channels=("/step",),
    hooks=Hooks(log_step=make),
)
