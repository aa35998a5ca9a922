"""Gyroscopic term: bodies with unequal principal inertias precess at constant angular momentum.

Implicit midpoint on the body's momentum P = I omega, in body axes, and Cayley's turn with its spin:
    m = P + dt/2 m x I^-1 m,    P' = 2 m - P,    q' = q turned by I^-1 m dt
P' is P turned back by the same Cayley map, so the world's angular momentum is kept; the midpoint
rule keeps quadratic invariants, so the energy is kept: both to round-off, for any inertia. m is
found by Newton's method.
"""

from math import sqrt

from ..records import GIVES, JUMPS
from ..terms import StepTerms
from .decision import Decision, Facts, named
from .effect import Column, Effect, Hooks, kernel

# Newton doubles the digits in each pass: four serve any |omega| dt < 1. A body that has not found
# its midpoint after these turns several radians a step, and the run ends: nothing here is true.
PASSES = 20
# Relative change of m, squared, at which its digits are found.
FOUND = 1e-28


def decide(facts: Facts) -> Decision:
    """On when a movable body that may turn has unequal principal inertias."""
    uneven = [
        body.name
        for body in facts.bodies
        if body.movable
        and not body.round
        and (body.spins or body.torque or body.twisted or bool(facts.pairs))
    ]
    if uneven:
        return Decision(True, f"{named(uneven)}: unequal principal inertias and may turn")
    return Decision(False, "no body that may turn has unequal principal inertias")


def make_find_middle(spec):
    """Return `kernel(body, px, py, pz, dt) -> (mx, my, mz, found)`: m of a momentum, body axes."""

    def find_middle(body, px, py, pz, dt):
        ix, iy, iz = body.inv_ix, body.inv_iy, body.inv_iz
        # (m x I^-1 m)_x = m_y m_z (1/I_z - 1/I_y), and so round the axes.
        a, b, c = 0.5 * dt * (iz - iy), 0.5 * dt * (ix - iz), 0.5 * dt * (iy - ix)
        mx, my, mz = px, py, pz
        size = px * px + py * py + pz * pz
        found = False
        for _ in range(PASSES):
            fx = px - mx + a * my * mz
            fy = py - my + b * mz * mx
            fz = pz - mz + c * mx * my
            # The Jacobian (1, -a mz, -a my; -b mz, 1, -b mx; -c my, -c mx, 1) by its adjugate.
            scale = 1.0 / (
                1.0
                - b * c * mx * mx
                - a * c * my * my
                - a * b * mz * mz
                - 2.0 * a * b * c * mx * my * mz
            )
            dx = (1.0 - b * c * mx * mx) * fx + a * (mz + c * mx * my) * fy
            dx = (dx + a * (my + b * mx * mz) * fz) * scale
            dy = b * (mz + c * mx * my) * fx + (1.0 - a * c * my * my) * fy
            dy = (dy + b * (mx + a * my * mz) * fz) * scale
            dz = c * (my + b * mx * mz) * fx + c * (mx + a * my * mz) * fy
            dz = (dz + (1.0 - a * b * mz * mz) * fz) * scale
            mx, my, mz = mx + dx, my + dy, mz + dz
            if dx * dx + dy * dy + dz * dz <= FOUND * size:
                found = True
                break
        return mx, my, mz, found

    return kernel(find_middle, spec)


def make(spec):
    """Return `kernel(body, velocity, dt) -> solved` that replaces the plain turn."""
    from ..rotation import to_body, to_world, turn

    find_middle = make_find_middle(spec)

    def integrate_gyroscopic(body, velocity, dt):
        wx, wy, wz = velocity.wx, velocity.wy, velocity.wz
        if wx == 0.0 and wy == 0.0 and wz == 0.0:
            return True
        ix, iy, iz = body.inv_ix, body.inv_iy, body.inv_iz
        if ix == iy and iy == iz:  # a round body turns at constant omega, to the bit
            turn(body, wx * dt, wy * dt, wz * dt)
            return True
        bx, by, bz = to_body(body, wx, wy, wz)
        px, py, pz = bx / ix, by / iy, bz / iz
        mx, my, mz, found = find_middle(body, px, py, pz, dt)
        if not found:
            return False
        wx, wy, wz = to_world(body, ix * mx, iy * my, iz * mz)
        turn(body, dt * wx, dt * wy, dt * wz)
        px, py, pz = 2.0 * mx - px, 2.0 * my - py, 2.0 * mz - pz
        velocity.wx, velocity.wy, velocity.wz = to_world(body, ix * px, iy * py, iz * pz)
        return True

    return kernel(integrate_gyroscopic, spec)


def make_find_pushed_middle(spec):
    """Return `kernel(body, p, g, dt) -> (mx, my, mz, found)`: m with impulses, body axes.

    p: momentum at the start, g: half of what impulses give, both in the body's axes at the start.
        m = p + g + dt/2 (m + g) x I^-1 m
    """

    def find_pushed_middle(body, p, g, dt):
        ix, iy, iz = body.inv_ix, body.inv_iy, body.inv_iz
        h = 0.5 * dt
        px, py, pz = p.x + g.x, p.y + g.y, p.z + g.z
        mx, my, mz = px, py, pz
        size = px * px + py * py + pz * pz
        found = False
        for _ in range(PASSES):
            x, y, z = mx + g.x, my + g.y, mz + g.z
            fx = px - mx + h * (y * iz * mz - z * iy * my)
            fy = py - my + h * (z * ix * mx - x * iz * mz)
            fz = pz - mz + h * (x * iy * my - y * ix * mx)
            # The Jacobian (1, a, b; c, 1, d; e, f, 1) of m less the right side, by its adjugate.
            a, b = h * (z * iy - iz * mz), h * (iy * my - y * iz)
            c, d = h * (iz * mz - z * ix), h * (x * iz - ix * mx)
            e, f = h * (y * ix - iy * my), h * (ix * mx - x * iy)
            p_x, p_y, p_z = 1.0 - d * f, d * e - c, c * f - e
            scale = 1.0 / (p_x + a * p_y + b * p_z)
            dx = scale * (p_x * fx + (b * f - a) * fy + (a * d - b) * fz)
            dy = scale * (p_y * fx + (1.0 - b * e) * fy + (b * c - d) * fz)
            dz = scale * (p_z * fx + (a * e - f) * fy + (1.0 - a * c) * fz)
            mx, my, mz = mx + dx, my + dy, mz + dz
            if dx * dx + dy * dy + dz * dz <= FOUND * size:
                found = True
                break
        return mx, my, mz, found

    return kernel(find_pushed_middle, spec)


def make_turn_midway(spec):
    """Return `kernel(body, start, m, lead, end, dt) -> found`: half a turn, with impulses' change.

    body: stands at a middle found before, with its spin there in `start.w` + what impulses change;
    start: its row at the start of the step. end: spin that the step ends with at that middle; lead:
    spin there before impulses, replaced. With L = I (w - lead) the momentum that they give, in the
    axes of the start, the turn R by I^-1 m dt is to leave the world R P' = P + L:
        m = (P + P')/2  =>  m = P + L/2 + dt/2 (m + L/2) x I^-1 m
    L works by L . I^-1 m, so the energy is kept, too. Of what a joint, a spring or what does not
    move holds (`m.restrained`) L is a torque in the axes of the middle,
        m = P + L/2 + dt/2 m x I^-1 m,
    which loses the world L (1 - cos) across the axis, half a turn's, and works the same. Nobody
    asks what the world gets of a floor; and beside stiff springs the passes of the other law may
    lead to no middle, or to one far away. The step's mean spin is I^-1 m = lead + I^-1 L/2 with I
    of the middle.
    """
    from ..rotation import half_turn, inertia_times, inverse_inertia_times, to_body, to_world
    from ..vectors import Vec3

    find_middle, find_pushed_middle = make_find_middle(spec), make_find_pushed_middle(spec)

    def turn_midway(body, start, m, lead, end, dt):
        x, y, z = end.wx - lead.wx, end.wy - lead.wy, end.wz - lead.wz
        lx, ly, lz = inertia_times(body, x, y, z)
        bx, by, bz = to_body(start, m.wx, m.wy, m.wz)
        ix, iy, iz = start.inv_ix, start.inv_iy, start.inv_iz
        px, py, pz = bx / ix, by / iy, bz / iz
        if m.restrained == 1 or (x == 0.0 and y == 0.0 and z == 0.0):
            gx, gy, gz = to_body(body, lx, ly, lz)
            px, py, pz = px + 0.5 * gx, py + 0.5 * gy, pz + 0.5 * gz
            px, py, pz, found = find_middle(start, px, py, pz, dt)
        else:
            gx, gy, gz = to_body(start, lx, ly, lz)
            half = Vec3(0.5 * gx, 0.5 * gy, 0.5 * gz)
            px, py, pz, found = find_pushed_middle(start, Vec3(px, py, pz), half, dt)
        wx, wy, wz = to_world(start, ix * px, iy * py, iz * pz)
        body.qw, body.qx, body.qy, body.qz = start.qw, start.qx, start.qy, start.qz
        half_turn(body, wx, wy, wz, dt)
        x, y, z = inverse_inertia_times(body, lx, ly, lz)
        lead.wx, lead.wy, lead.wz = wx - 0.5 * x, wy - 0.5 * y, wz - 0.5 * z
        return found

    return kernel(turn_midway, spec)


def make_turn_by_mean(spec):
    """Return `kernel(body, velocity, mean, end, kind, dt)`: turn with a spin of the middle.

    velocity: spin at its start, replaced by that at its end. mean, end: spins at the middle, of the
    step and of its end there. It turns with the mean, or with the end what a contact makes jump
    (JUMPS). Its spin is then, in body axes, 2 omega_m - omega_0, of the mean: energy is kept to the
    last digit, momentum to what the solve leaves. GIVES: what it is pushed by moves, too, and gets
    what it takes: the world's momentum grows by L = 2 I (end - mean) to the last digit, and energy
    is kept to what the solve leaves.
    """
    from ..rotation import half_turn, inertia_times, inverse_inertia_times, to_body, to_world, turn

    def turn_by_mean(body, velocity, mean, end, kind, dt):
        if kind != GIVES:
            spin = end if kind == JUMPS else mean
            ax, ay, az = to_body(body, velocity.wx, velocity.wy, velocity.wz)
            bx, by, bz = to_body(body, mean.x, mean.y, mean.z)
            turn(body, spin.x * dt, spin.y * dt, spin.z * dt)
            velocity.wx, velocity.wy, velocity.wz = to_world(
                body, 2.0 * bx - ax, 2.0 * by - ay, 2.0 * bz - az
            )
            return
        px, py, pz = inertia_times(body, velocity.wx, velocity.wy, velocity.wz)
        half_turn(body, mean.x, mean.y, mean.z, dt)
        lx, ly, lz = inertia_times(body, end.x - mean.x, end.y - mean.y, end.z - mean.z)
        half_turn(body, mean.x, mean.y, mean.z, dt)
        velocity.wx, velocity.wy, velocity.wz = inverse_inertia_times(
            body, px + 2.0 * lx, py + 2.0 * ly, pz + 2.0 * lz
        )

    return kernel(turn_by_mean, spec)


def make_jump(spec):
    """Return `kernel(body, velocity, x, y, z, twice_spent)`: add a jump of spin within a step.

    The solver found the jump dw [rad/s] with the inertia I_0 of the step's start, and counts on the
    energy dw . L + dw . I_0 dw / 2 for it; twice_spent is dw . I_0 dw [J]. By then the body has
    turned, so dw is scaled by the root near 1 of
        beta dw . L + beta^2 dw . I dw / 2 = dw . L + dw . I_0 dw / 2,    L = I omega;
    a jump that takes all that its direction can take has no such root, and scales the spin instead.
    """
    from ..rotation import inertia_times, is_round

    def jump(body, velocity, x, y, z, twice_spent):
        if is_round(body):
            velocity.wx += x
            velocity.wy += y
            velocity.wz += z
            return
        ix, iy, iz = inertia_times(body, x, y, z)
        along = ix * velocity.wx + iy * velocity.wy + iz * velocity.wz
        spent = ix * x + iy * y + iz * z
        if spent == 0.0:
            return
        squared = along * along + spent * (2.0 * along + twice_spent)
        root = sqrt(max(squared, 0.0))
        if along + spent < 0.0:
            root = -root
        # Of two forms of the same root the one that does not cancel.
        if along * root > 0.0:
            share = (2.0 * along + twice_spent) / (along + root)
        else:
            share = (root - along) / spent
        wx, wy, wz = velocity.wx, velocity.wy, velocity.wz
        scale = 1.0
        if squared < 0.0:
            lx, ly, lz = inertia_times(body, wx, wy, wz)
            before = lx * wx + ly * wy + lz * wz
            left = before - along * along / spent
            if left > 0.0:
                scale = sqrt(max(before + 2.0 * along + twice_spent, 0.0) / left)
        velocity.wx = scale * (wx + share * x)
        velocity.wy = scale * (wy + share * y)
        velocity.wz = scale * (wz + share * z)

    return kernel(jump, spec)


def acts_midway(spec):
    """Whether bodies turn to the middle of a step, where one that is not found ends no run."""
    from ..row_terms import row_terms

    return row_terms(spec).shifted


def make_step_row(spec):
    """Return `kernel(row, bodies, counters)` that says how many middles were not found."""
    midway = acts_midway(spec)

    def log_not_found(row, bodies, counters):
        if midway:
            row.gyroscopic_not_converged = counters.gyroscopic_not_converged

    return kernel(log_not_found, spec)


EFFECT = Effect(
    name="gyroscopic",
    decide=decide,
    per="body",
    needs=("rotation",),
    step=StepTerms(uneven=True),
    counts=("gyroscopic_not_converged",),
    step_columns=(
        Column(
            "gyroscopic_not_converged",
            "i8",
            "bodies whose turn to the middle of the step took all its passes",
            number=51,
            when=acts_midway,
        ),
    ),
    hooks=Hooks(
        turn_uneven=make,
        turn_midway=make_turn_midway,
        turn_by_mean=make_turn_by_mean,
        add_spin=make_jump,
        step_row=make_step_row,
    ),
)
