"""The fit of impulses to a change of momentum: optimality, closed forms, both factorisations."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy import sparse

from lavendersim.problems import impulse_fit
from lavendersim.problems.impulse_fit import fit_impulses

RANDOM = np.random.default_rng(7)
# Numbers of order 1, up to 90 contacts in 60 columns: thousands of roundings of 1e-16.
ROUND_OFF = 1e-12


def problem(contacts: int, columns: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return G, mu and a change of momentum that impulses on the cones' sides explain."""
    G = RANDOM.normal(size=(3 * contacts, columns))
    mu = RANDOM.uniform(0.0, 1.0, contacts)
    impulses = RANDOM.normal(size=(contacts, 3))
    impulses[:, 0] = np.abs(impulses[:, 0])
    side = np.hypot(impulses[:, 1], impulses[:, 2])
    impulses[:, 1:] *= (mu * impulses[:, 0] / side)[:, None]  # sliding: on the side of the cone
    impulses[RANDOM.random(contacts) < 0.3] = 0.0
    return G, mu, G.T @ impulses.ravel()


def outside(impulses: np.ndarray, mu: np.ndarray) -> float:
    return float(np.max(np.hypot(impulses[:, 1], impulses[:, 2]) - mu * impulses[:, 0]))


@pytest.mark.parametrize(("contacts", "columns"), [(1, 6), (4, 6), (30, 24), (90, 60)])
def test_what_impulses_explain_is_explained_to_round_off(contacts: int, columns: int) -> None:
    """However redundant the contacts, on the sides of their cones or not."""
    G, mu, b = problem(contacts, columns)
    for allowed in ("cone", "push", "any"):
        fit = fit_impulses(G, b, mu, allowed)
        assert np.linalg.norm(fit.left) < 1e-14 * np.linalg.norm(b)
        if allowed == "cone":
            assert outside(fit.impulses, mu) < ROUND_OFF


@pytest.mark.parametrize(("contacts", "columns"), [(1, 6), (4, 6), (4, 12), (10, 24)])
def test_it_is_the_least_by_the_conditions_of_kuhn_and_tucker(contacts: int, columns: int) -> None:
    """With u = -G left: r in K, u in K*, u . r = 0; K* is |u_t| mu <= u_n for a cone."""
    G, mu, b = problem(contacts, columns)
    b = b + RANDOM.normal(size=columns)
    for allowed in ("cone", "push", "any"):
        fit = fit_impulses(G, b, mu, allowed)
        u = -(G @ fit.left).reshape(-1, 3)
        assert abs(np.vdot(u, fit.impulses)) < ROUND_OFF * np.linalg.norm(b) ** 2
        side = np.hypot(u[:, 1], u[:, 2])
        if allowed == "cone":
            assert np.max(mu * side - u[:, 0]) < ROUND_OFF * np.linalg.norm(b)
        else:
            assert side.max() < ROUND_OFF * np.linalg.norm(b)
            lowest = np.min(u[:, 0]) if allowed == "push" else -np.max(np.abs(u[:, 0]))
            assert lowest > -ROUND_OFF * np.linalg.norm(b)


def test_friction_beyond_the_cone_by_hand() -> None:
    """One particle: the nearest point of the cone; (1, 0.8) at mu 1/2 misses it by 0.3 cos."""
    fit = fit_impulses(np.eye(3), np.array([1.0, 0.8, 0.0]), np.array([0.5]))
    foot = (1.0 + 0.5 * 0.8) / 1.25
    assert fit.impulses == pytest.approx(np.array([[foot, 0.5 * foot, 0.0]]), abs=ROUND_OFF)
    assert np.linalg.norm(fit.left) == pytest.approx(0.3 / np.sqrt(1.25), rel=1e-14)


def test_large_problems_are_factorised_sparse_to_the_same_answer(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    G, mu, b = problem(12, 12)
    b = b + RANDOM.normal(size=12)
    dense = fit_impulses(G, b, mu)
    monkeypatch.setattr(impulse_fit, "LARGEST_DENSE", 0)
    thin = fit_impulses(sparse.csr_matrix(G), b, mu)
    assert thin.left == pytest.approx(dense.left, abs=ROUND_OFF * np.linalg.norm(b))


def test_a_cost_chooses_among_redundant_impulses_and_takes_nothing_from_the_fit() -> None:
    """Two equal contacts, one of which costs: the other carries all but what rounds leave."""
    G = np.vstack([np.eye(3), np.eye(3)])
    cost = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    fit = fit_impulses(G, np.array([2.0, 0.0, 0.0]), np.array([0.5, 0.5]), cost=cost)
    assert np.linalg.norm(fit.left) < 1e-14
    assert fit.impulses[0, 0] < 1e-6
    assert fit.impulses[:, 0].sum() == pytest.approx(2.0, rel=1e-14)


def test_without_contacts_or_momentum_there_is_nothing_to_find() -> None:
    none = fit_impulses(np.zeros((0, 6)), np.arange(6.0), np.zeros(0))
    assert none.left.tolist() == list(range(6))
    assert not fit_impulses(np.eye(3), np.zeros(3), np.ones(1)).impulses.any()


def test_a_contact_that_moves_nothing_gets_no_impulse() -> None:
    G = np.vstack([np.zeros((3, 3)), np.eye(3)])
    fit = fit_impulses(G, np.array([1.0, 0.0, 0.0]), np.ones(2))
    assert not fit.impulses[0].any()
    assert np.linalg.norm(fit.left) < 1e-15


def test_a_round_ends_where_round_off_does(monkeypatch: pytest.MonkeyPatch) -> None:
    """What no impulse explains leaves y of size left / SOFTNESS, and F as exact as that.

    Newton's steps are quadratic: from an error of 1 to the last bit six halvings of the exponent,
    some more where contacts change between sticking, sliding and parting; a round that asked for
    more than that level has would make all its 60.
    """
    counts = {"steps": 0, "rounds": 0}
    step, one_round = impulse_fit._Rows.step, impulse_fit._round

    def counted(*given: Any) -> np.ndarray:
        counts["steps"] += 1
        return step(*given)

    def rounds(*given: Any) -> Any:
        counts["rounds"] += 1
        return one_round(*given)

    monkeypatch.setattr(impulse_fit._Rows, "step", counted)
    monkeypatch.setattr(impulse_fit, "_round", rounds)
    for seed in range(10):
        random = np.random.default_rng(seed)
        # a box on its face, twelve points of three poses: they push up, and it is pulled down
        place = random.normal(size=(12, 3)) * (1.0, 1.0, 0.01)
        G = np.array([np.hstack([turn, np.cross(at, turn)]) for at in place for turn in FRAME])
        b = np.array([0.1, 0.05, -1.0, *random.normal(size=3)])
        fit_impulses(G, b, np.full(12, 0.5))
    assert counts["steps"] < 8 * counts["rounds"]


FRAME = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
