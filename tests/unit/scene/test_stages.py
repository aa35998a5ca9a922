"""Bodies over time: a stage for each change of a surface, and what a plan makes of all of them."""

from __future__ import annotations

from laboratory import box, config, plane, planned, resolved, sphere

from lavendersim.cell import Surface
from lavendersim.scene.facts import facts_of
from lavendersim.scene.stages import later_forms, stages_of

ICE, WOOD, BELT = Surface(), Surface(friction=0.5), (1.0, 0.0, 0.0)


def event(at: float, name: str, **changes: object) -> dict:
    none = dict.fromkeys(("scale_mass", "teleport", "velocity", "angular_velocity"))
    kept = {"contact_cache": "keep", "remove": False}
    return {"at": at, "body": name, **none, **kept, **changes}


def cell(*events: dict, friction: float = 0.0) -> dict:
    bodies = {
        "floor": plane(friction=friction),
        "box": box((1, 1, 1), (0, 0, 0.5), friction=0.5),
        "ball": sphere(0.1, (3, 0, 0.1)),
    }
    return resolved(bodies, (0.0, 0.0, -9.81)) | {"events": list(events)}


def test_a_scene_whose_surfaces_stay_has_one_stage() -> None:
    thrown = config(cell(event(0.5, "box", velocity=[1.0, 0.0, 0.0])))
    assert stages_of(thrown) == [thrown.scene.bodies]
    assert later_forms(thrown) == {}


def test_each_change_of_a_surface_begins_a_stage_whatever_the_order_in_the_file() -> None:
    events = [
        event(0.7, "floor", surface=ICE.model_dump()),
        event(0.2, "floor", surface=WOOD.model_dump(), surface_velocity=list(BELT)),
    ]
    changed = config(cell(*events))
    first, second, third = (stage["floor"] for stage in stages_of(changed))
    assert first.surface == ICE
    assert (second.surface, second.surface_velocity) == (WOOD, BELT)
    assert (third.surface, third.surface_velocity) == (ICE, BELT)  # the belt runs on
    assert later_forms(changed) == {"floor": (second, third)}


def test_a_plan_has_what_only_a_later_surface_requires() -> None:
    assert not planned(cell()).decisions["friction"].on
    frictional = planned(cell(event(0.5, "floor", surface=WOOD.model_dump()))).decisions
    assert frictional["friction"].on
    assert not frictional["surface_velocity"].on
    belt = event(0.6, "floor", surface_velocity=list(BELT))
    assert planned(cell(belt, friction=0.5)).decisions["surface_velocity"].on


def test_a_plan_has_gravity_that_only_comes_later() -> None:
    floating = cell({"at": 0.5, "gravity": [0.0, 0.0, -1.62]})
    floating["scene"]["gravity"] = [0.0, 0.0, 0.0]
    decided = planned(floating).decisions["gravity"]
    assert (decided.on, decided.reason) == (
        True,
        "gravity is zero at first, and (0, 0, -1.62) m/s^2 later",
    )


def test_pairs_of_all_stages_stand_once_and_are_counted_once() -> None:
    """Three pairs touch, whatever their surfaces; that of floor and box is of two surfaces."""
    again = [event(at, "floor", surface=WOOD.model_dump()) for at in (0.2, 0.4)]
    facts = facts_of(config(cell(*again)))
    assert facts.pair_count == 3
    assert len(facts.pairs) == 4


def test_an_event_that_turns_a_body_is_the_reason_for_rotation() -> None:
    turned = cell(event(0.5, "ball", orientation=[0.0, 1.0, 0.0, 0.0]))
    del turned["scene"]["bodies"]["box"]
    assert planned(turned).decisions["rotation"].reason == "ball: an event turns it"


def test_surfaces_that_triggers_bring_meet_in_every_pair() -> None:
    """Floor and box change by triggers, the floor's belt at a time: in any order."""
    when = {"condition": "slower_than", "bodies": ["box"], "value": 0.1}
    changed = config(
        cell(event(0.6, "floor", surface_velocity=list(BELT)))
        | {
            "triggered": [
                {"when": when, "event": event(0.0, "floor", surface=WOOD.model_dump())},
                {"when": when, "event": event(0.0, "box", surface=ICE.model_dump())},
            ]
        }
    )
    forms = later_forms(changed)
    floors = {(one.surface.friction, one.surface_velocity) for one in forms["floor"]}
    still = (0.0, 0.0, 0.0)
    assert floors == {(0.0, BELT), (0.5, still), (0.5, BELT)}
    assert [one.surface for one in forms["box"]] == [ICE]
    pairs = {
        (one["floor"].surface.friction, one["floor"].surface_velocity, one["box"].surface.friction)
        for one in stages_of(changed)
    }
    assert pairs == {(*floor, box) for floor in {(0.0, still), *floors} for box in (0.5, 0.0)}
