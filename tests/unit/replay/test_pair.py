"""Distances of bodies from themselves in another log, at the times that both have."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from synthetic_trace import ball_and_box

from lavendersim.replay.pair import LogPair, distances_of


def moved(metres, body="ball", first=0):
    trace = ball_and_box()
    pose = trace.pose.copy()
    pose[first:, trace.bodies.index(body), 1] += metres
    return replace(trace, pose=pose)


def test_a_log_is_nowhere_apart_from_itself(two_bodies):
    found = distances_of(LogPair(two_bodies, ball_and_box(), "a", "b"))
    assert {one.body for one in found.bodies} == {"ball", "box"}
    assert all((one.metres == 0.0).all() for one in found.bodies)
    assert (found.times == two_bodies.step["time_ns"]).all()


def test_the_farthest_body_comes_first_from_the_step_where_it_parts(two_bodies):
    found = distances_of(LogPair(two_bodies, moved(0.25, first=100), "a", "b"))
    ball = found.bodies[0]
    assert ball.body == "ball"
    # y of the ball is 0, so 0.25 is added without round-off
    assert (ball.metres == np.where(np.arange(len(found.times)) < 100, 0.0, 0.25)).all()


def test_of_another_timestep_the_common_times_count(two_bodies):
    other = moved(0.5)
    half = replace(other, step=other.step[::2], pose=other.pose[::2])
    found = distances_of(LogPair(two_bodies, half, "a", "b"))
    assert (found.times == other.step["time_ns"][::2]).all()
    assert (found.bodies[0].metres == 0.5).all()


def test_a_body_of_one_log_alone_has_no_distance(two_bodies):
    other = ball_and_box()
    ball = other.bodies.index("ball")
    bodies = [name for name in other.bodies if name != "ball"]
    without = replace(other, bodies=bodies, pose=np.delete(other.pose, ball, axis=1))
    assert [one.body for one in distances_of(LogPair(two_bodies, without, "a", "b")).bodies] == [
        "box"
    ]


def test_names_in_titles_are_as_short_as_tells_them_apart(two_bodies):
    early, late = "20261127T033502Z-", "20261127T033502Z.001-"

    def short(a, b):
        return LogPair(two_bodies, two_bodies, a, b).short_names

    assert short(f"{early}dry-480cfbff", f"{late}icy-cc1c1853") == ("dry", "icy")
    assert short(f"{early}dry-480cfbff", f"{late}dry-cc1c1853") == (
        "dry-480cfbff",
        "dry-cc1c1853",
    )
    whole = f"{early}dry-480cfbff", f"{late}dry-480cfbff"
    assert short(*whole) == whole
    assert short(f"{early}dry-480cfbff e=0.5", f"{early}dry-480cfbff e=1") == (
        "dry e=0.5",
        "dry e=1",
    )
