"""Which rounds without shifts are kept, how soft the next is, and where they end.

One contact without friction that should carry lambda: off by d its residual is k d. What a round's
root is, is scripted; impulses and velocities follow as they do of any root.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from drawn_contacts import drawn, stacked, views
from interpreted import interpreted, records

from lavendersim.engine.solvers.newton import alart_curnier
from lavendersim.engine.solvers.newton.alart_curnier import BROUGHT, CUT, SOFTER, WORSE
from lavendersim.engine.solvers.newton.envelope import allocate_envelope
from lavendersim.engine.solvers.newton.method import step_cost
from lavendersim.engine.solvers.newton.rounds import SOFTEST
from lavendersim.engine.solvers.solver import ContactSystem
from lavendersim.engine.spec import Spec

SPEC = Spec(effects=("friction", "newton", "rotation"), solver="adaptive")
LOST = None  # a round without a root


class Rounds:
    """Rounds whose roots are off by what a script says, from an impulse that is off by 1 N s."""

    def __init__(
        self, monkeypatch: Any, script: list[float | None], enough: float = 0.0, most: float = 1e9
    ) -> None:
        scene = drawn(SPEC, np.random.default_rng(3), [(0, 1)])
        row = scene.contacts
        row["mu"] = row["lambda_1"] = row["lambda_2"] = 0.0
        # With 1 N s taken away the row asks for nothing.
        carried = float(row["lambda_n"][0]) - 1.0 + 5.0
        row["lambda_n"] += 5.0
        k = float(row["k_n"][0])
        free = scene.motion - scene.inverse @ scene.jacobian[0] * float(row["lambda_n"][0])
        row["target"] = -(scene.jacobian[0] @ free + k * carried)
        bodies, velocities, contacts = views(scene)
        self.starts: list[float] = []
        self.softness: list[float] = []

        def find_root(contacts: Any, count: int, *others: Any) -> tuple[int, bool]:
            contact, off = contacts[0], script[len(self.starts)]
            self.starts.append(float(contact.lambda_n) - carried)
            self.softness.append(1.0 / (contact.stiff_n * contact.k_n))
            required = carried + (99.0 if off is LOST else off)
            contact.velocity_n = (contact.start_n - required) / contact.stiff_n
            return 1, off is not LOST

        monkeypatch.setattr(alart_curnier, "make_find_root", lambda spec: find_root)
        workspace = records(allocate_envelope(2, 1, 200, upper=200))
        system = ContactSystem(contacts, None, 1, bodies, velocities)
        size, _ = interpreted(step_cost)(system, workspace)
        solve = interpreted(alart_curnier.make_alart_curnier(SPEC))
        self.steps = solve(system, workspace, size, most, (1e-9 * k, enough * k), SOFTEST)
        self.left = float(row["lambda_n"][0]) - carried
        # Sums of a few dozen impulses below 100 N s, of bodies of 0.3 kg and more.
        expected = free + scene.inverse @ scene.jacobian[0] * float(row["lambda_n"][0])
        np.testing.assert_allclose(stacked(scene.velocities), expected, atol=1e-10)


def near(values: list[float]) -> Any:
    return pytest.approx(values, rel=1e-9, abs=1e-9)


def test_a_round_goes_on_from_the_last_that_was_kept_and_the_least_is_left(monkeypatch) -> None:
    """What leaves more than WORSE times the least is taken back, and what has no root not taken."""
    worse = 0.5 * WORSE
    script = [0.5, 1.01 * worse, LOST, 0.99 * worse, 0.2, 0.4]
    rounds = Rounds(monkeypatch, script, most=len(script))
    assert rounds.starts == near([1.0, 0.5, 0.5, 0.5, 0.99 * worse, 0.2])
    assert rounds.left == near(0.2)
    assert rounds.steps == len(script)


def test_a_round_behind_one_that_failed_is_as_soft_as_the_last_that_was_kept(monkeypatch) -> None:
    """And softer where it fails as well; then softness falls by the root of CUT, once."""
    script = [0.5, LOST, LOST, 0.4, 0.3, 0.2]
    rounds = Rounds(monkeypatch, script, most=len(script))
    soft = SOFTEST / CUT
    expected = [SOFTEST, CUT * SOFTEST, SOFTEST, soft, np.sqrt(CUT) * soft, CUT * soft]
    assert rounds.softness == near(expected)
    assert Rounds(monkeypatch, [LOST] * 9).softness == near([SOFTEST, SOFTER * SOFTEST])


def test_rounds_end_at_what_is_asked_or_where_they_bring_no_more(monkeypatch) -> None:
    assert Rounds(monkeypatch, [0.5, 1e-10, 0.1]).steps == 2
    # Below what is enough, rounds go on while each brings BROUGHT of the one before.
    brings, brings_less = 0.99 * BROUGHT, 1.01 * BROUGHT
    for last, steps in ((brings, 3), (brings_less, 2)):
        script = [0.1, 0.1 * last, 0.1 * last]
        assert Rounds(monkeypatch, script, enough=0.05).steps == steps
    assert Rounds(monkeypatch, [0.5], enough=1.01).steps == 0


def test_what_is_taken_back_leaves_no_digit_of_it_in_velocities(monkeypatch) -> None:
    """Of 1e12 N s the last digit is 1e-4: `Rounds` allows velocities 1e-10 m/s."""
    assert Rounds(monkeypatch, [0.5, 1e12, 0.4, 0.3], most=4).left == near(0.3)
