"""Terms that effects declare: what contacts' rows are made of, what a step reckons with.

Whoever asks, asks for a term (`row_terms`, `step_terms`) and not for the effect that brings it.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class RowTerms:
    """What contacts' rows are made of. Solvers ask for these terms, and never for an effect.

    An effect that declares a term brings the fields it is written in; one that several bring stands
    once. What an engine has of them: `row_terms.row_terms`.
    """

    frictional: bool = False  # rows of three, along n, t1 and t2: see `block`
    frictionless: bool = False  # rows of a normal alone, beside those
    compliant: bool = False  # gamma lambda_n adds to w_n: `gamma`, from 0 in each step [1/kg]
    torsional: bool = False  # an angular impulse psi_n about n: see `spin_block` [N m s]
    rolling: bool = False  # psi_1, psi_2 in the tangent plane [N m s]
    levers: bool = False  # of rows of a normal: impulses turn bodies
    bilateral: bool = False  # some of a normal have no cone: `bilateral` is 1, either sign [N s]
    bounded: bool = False  # some of those, motors, have a largest impulse, `most`: see `motor`
    stopped: bool = False  # some of a normal are stops of joints: `stop` is 1
    coupled: bool = False  # an impulse p turns about n by e . p beside its lever: `patch` [m]
    stretched: bool = False  # tangents of other lengths than 1, whose squares' inverses are `ease`
    varied: bool = False  # mu is another in each step: impulses that are kept may lie outside
    shifted: bool = False  # surface_1, surface_2 add to the slip [m/s]
    taut: bool = False  # some of a normal are ropes: `span` is above 0 [m]
    elastic: bool = False  # some push as springs, `spring_compliance`, never at an instant
    curved: bool = False  # some of those by Hertz's law, `hertz_stiffness`: `contact_spring_law`
    yielding: bool = False  # some give way along their surface: gamma_t lambda_t adds to the slip
    swept: bool = False  # some are of where fast bodies meet: `tangential_x`, y, z [m]


@dataclass(frozen=True, kw_only=True)
class StepTerms:
    """What a step reckons with, beside contacts' rows: how bodies move, when impacts happen.

    An effect that declares a term brings the fields it is written in.
    """

    turns: bool = False  # bodies have an orientation and a spin
    uneven: bool = False  # some have unequal principal inertias: their spin changes by itself
    kinematic: bool = False  # some keep their velocity, whatever touches them: `kinematic` is 1
    sprung: bool = False  # springs act between bodies: LINK
    mean_flight: bool = False  # what flies moves by the mean of its old and new velocity: `dv_n`
    centred: bool = False  # what lasts has its rows at the middle of the step: `lasts` is 1
    ahead: bool = False  # gaps that bodies may close in the step have rows
    rebounds: bool = False  # some pairs give back of the approach speed: PAIR.restitution
    timed_impacts: bool = False  # impacts have a time within the step: `tau` [s]
    ordered_impacts: bool = False  # and follow each other there: steps are made in parts
    bounces_vary: bool = False  # those of a contact alone are no powers of e
    overlooks: bool = False  # points without a row are looked over once it is solved: PAIR.whole
    periodic: bool = False  # bodies have images: `period_x`, y, z [m], 0: none along that axis
    substeps: bool = False  # steps are made in substeps, by an error that is asked for
