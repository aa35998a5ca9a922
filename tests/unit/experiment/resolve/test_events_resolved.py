"""Events with nothing left open: surfaces in place, turns and vectors in the frames of bodies."""

from __future__ import annotations

import math

import numpy as np
import pytest

from lavendersim.cell import CellEvent, CellGravity
from lavendersim.cell.mixing import mixed
from lavendersim.experiment import load_experiment_text
from lavendersim.geometry.quaternions import axes

WEDGE = "{kind: hull, points: [[0, 0, 0], [1, 0, 0], [0, 0.5, 0], [0.2, 0.1, 0.7], [1, 1, 0]]}"
TEXT = """\
scene:
  surfaces: {{ice: {{friction: 0.0}}, wood: {{friction: 0.5}}}}
  surface_pairs: {{sledge: {{between: [ice, wood], friction: 0.02}}}}
  bodies:
    floor: {{shape: {{kind: plane}}, surface: wood}}
    wedge: {{shape: {wedge}, mass: 1, position: [0, 0, 3], orientation: [0.9, 0.1, -0.3, 0.2]}}
events:
  - {event}
duration: 1
"""


def resolved(event: str) -> tuple:
    text = TEXT.format(event=event, wedge=WEDGE)
    config = load_experiment_text(text, "events.yaml").cells()[0].config
    return config.events[0], config.scene.bodies


def test_a_new_orientation_puts_the_points_where_the_file_says() -> None:
    """Written points p about the centre of mass c are at T (p - c), T a quarter turn about z."""
    event, bodies = resolved("{at: 0.5, body: wedge, orientation: {axis: [0, 0, 1], degrees: 90}}")
    shape = bodies["wedge"].shape
    written = np.array([[0, 0, 0], [1, 0, 0], [0, 0.5, 0], [0.2, 0.1, 0.7], [1, 1, 0]], float)
    quarter = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    found = np.array(shape.points) @ np.array(axes(event.orientation))
    np.testing.assert_allclose(found, (written - shape.centre) @ quarter.T, atol=1e-14)
    assert event.contact_cache == "clear"


def test_a_belt_of_an_event_moves_as_the_file_says_in_the_world() -> None:
    event, bodies = resolved("{at: 0.5, body: wedge, surface_velocity: [0, 0, 2]}")
    assert isinstance(event, CellEvent)
    matrix = np.array(axes(bodies["wedge"].orientation)).T
    w, x, y, z = np.array([0.9, 0.1, -0.3, 0.2]) / math.sqrt(0.95)
    up = [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)]
    found = matrix @ np.array(event.surface_velocity)
    np.testing.assert_allclose(found, 2.0 * np.array(up), atol=1e-14)


def test_a_surface_by_its_name_has_its_partners() -> None:
    event, bodies = resolved("{at: 0.5, body: wedge, surface: ice}")
    assert mixed(event.surface, bodies["floor"].surface).friction == 0.02
    event, bodies = resolved("{at: 0.5, body: wedge, surface: {friction: 0.08}}")
    # the geometric mean of 0.08 and 0.5, one rounding each for product and root
    assert mixed(event.surface, bodies["floor"].surface).friction == pytest.approx(0.2, rel=4e-16)


def test_what_an_event_does_not_say_is_left() -> None:
    event, _ = resolved("{at: 0.5, body: wedge, velocity: [1, 2, 3]}")
    assert event.model_dump() == {
        "at": 0.5, "body": "wedge", "scale_mass": None, "teleport": None,
        "velocity": (1.0, 2.0, 3.0), "angular_velocity": None, "contact_cache": "keep",
        "remove": False,
    }  # fmt: skip


def test_gravity_of_an_event_is_a_vector() -> None:
    event, _ = resolved("{at: 0.5, gravity: 1.62}")
    assert event == CellGravity(at=0.5, gravity=(0.0, 0.0, -1.62))
