"""Rows of contacts with a grain and without, and what the log has of them, along any normal."""

from __future__ import annotations

import numpy as np
import pytest
from drawn_contacts import random_frame
from interpreted import interpreted
from laboratory import EVERYTHING
from plain_facts import one_row, vector_fields

from lavendersim.engine.effects import anisotropic_friction


def test_what_has_no_grain_slips_along_its_tangents_as_it_is() -> None:
    stretch = interpreted(anisotropic_friction.make_stretch(EVERYTHING))
    for across, grain in ((2.0, 0.0), (0.0, 1.0)):
        contact = one_row(ease_1=7.0, ease_2=8.0, stretched=1)
        bodies = [one_row(**vector_fields("grain_", (0.0, part, 0.0))) for part in (0.0, grain)]
        stretch(contact, *bodies, one_row(across_grain=across))
        assert (contact.ease_1, contact.ease_2, contact.stretched) == (1.0, 1.0, 0)


def test_the_log_has_unit_tangents_of_any_normal_and_the_vectors_as_they_are(rng) -> None:
    """Impulse and slip in the world, and F of the ellipse along the log's tangents."""
    log = interpreted(anisotropic_friction.make_contact_row(EVERYTHING))
    zero = dict.fromkeys(("impulse_t1", "impulse_t2", "friction", "slip_t1", "slip_t2"), 0.0)
    zero |= dict.fromkeys(("friction_11", "friction_12", "friction_22"), 0.0)
    for _ in range(10):
        normal, e, f = random_frame(rng)
        eases, mu, impulses = rng.uniform(0.3, 3.0, 2), 0.4, rng.normal(size=2)
        tangents = [e / np.sqrt(eases[0]), f / np.sqrt(eases[1])]
        contact = one_row(
            **vector_fields("n", normal),
            **vector_fields("t1", tangents[0]),
            **vector_fields("t2", tangents[1]),
            **dict(zip(("ease_1", "ease_2"), eases, strict=True)),
            **dict(zip(("lambda_1", "lambda_2"), impulses, strict=True)),
            mu=mu, stretched=1,
        )  # fmt: skip
        slip = rng.normal() * e + rng.normal() * f
        out = one_row(**zero, **vector_fields("t1", np.zeros(3)))
        out.slip_t1, out.slip_t2 = (float(slip @ t) for t in tangents)
        log(out, contact, None, None)
        one = np.array([out.t1x, out.t1y, out.t1z])
        frame = np.array([one, np.cross(normal, one)])
        np.testing.assert_allclose(frame @ frame.T, np.eye(2), atol=1e-14)
        np.testing.assert_allclose(frame @ normal, 0.0, atol=1e-14)
        pushed = impulses @ tangents
        found = {name: [out[f"{name}_t1"], out[f"{name}_t2"]] for name in ("impulse", "slip")}
        np.testing.assert_allclose(found["impulse"] @ frame, pushed, atol=1e-14)
        np.testing.assert_allclose(found["slip"] @ frame, slip, atol=1e-13)
        long = mu / np.sqrt(eases)
        matrix = frame @ (long[0] * np.outer(e, e) + long[1] * np.outer(f, f)) @ frame.T
        logged = [[out.friction_11, out.friction_12], [out.friction_12, out.friction_22]]
        np.testing.assert_allclose(logged, matrix, atol=1e-14)
        # |F^-1 p| of the ellipse is |lambda|, of which mu is the most by n.
        along = np.linalg.norm(np.linalg.solve(matrix, frame @ pushed))
        assert out.friction == pytest.approx(np.linalg.norm(pushed) / along, rel=1e-12)
