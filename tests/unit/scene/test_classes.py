"""Pairs of classes say for thousands of bodies what a list of all pairs says for few."""

from __future__ import annotations

import math
from collections import Counter

import numpy as np
import pytest
from laboratory import body, box, config, plane, resolved, sphere

from lavendersim.cell import CellBody
from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.spec import Spec
from lavendersim.scene.build import build
from lavendersim.scene.candidates import candidate_pairs
from lavendersim.scene.classes import class_pairs, classes_of
from lavendersim.scene.colliders import colliders
from lavendersim.scene.facts import facts_of
from lavendersim.scene.plan import plan_of

KINDS = [
    {"kind": "sphere", "radius": 0.1},
    {"kind": "box", "size": [0.1, 0.2, 0.3]},
    {"kind": "capsule", "radius": 0.1, "length": 0.3},
    {"kind": "cylinder", "radius": 0.1, "length": 0.3},
    {"kind": "hull", "points": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]},
]
FRICTION = Spec(effects=("broad_phase", "compliance", "compound", "friction", "restitution"))


def bodies_of(*described: dict) -> list[CellBody]:
    """Return bodies as a config has them."""
    cell = config(resolved({f"body_{k}": one for k, one in enumerate(described)}))
    return list(cell.scene.bodies.values())


def crowd(seed: int, count: int, compounds: bool = False) -> list[dict]:
    """Bodies of random shapes, surfaces and movability, all at the origin."""
    rng = np.random.default_rng(seed)
    shapes = [*KINDS]
    if compounds:
        parts = [{"shape": KINDS[0]}, {"shape": KINDS[1], "position": [1, 0, 0]}]
        shapes.append({"kind": "compound", "parts": parts})
    found = [plane(friction=0.3), plane((0, 1, 0))]
    for _ in range(count):
        properties = {"friction": float(rng.choice([0.0, 0.5])), "fixed": bool(rng.random() < 0.3)}
        properties["restitution"] = float(rng.choice([0.0, 0.8]))
        found.append(body(shapes[rng.integers(len(shapes))], **properties))
    return found


@pytest.mark.parametrize("seed", range(5))
def test_classes_hold_every_pair_of_the_list(seed: int) -> None:
    bodies = bodies_of(*crowd(seed, 12))
    listed = Counter((p.shape_pair, p.surface) for p in candidate_pairs(bodies))
    rows = colliders(bodies)
    classes = class_pairs(rows)
    counted: Counter = Counter()
    for pair in classes:
        counted[pair.shape_pair, pair.surface] += pair.row_pairs
        kinds = (rows[pair.a].kind, rows[pair.b].kind)
        assert kinds == SHAPE_PAIRS[pair.shape_pair].shapes
    assert counted == listed
    first = [sorted((pair.a, pair.b)) for pair in classes]
    assert first == sorted(first)


@pytest.mark.parametrize("seed", range(5))
def test_templates_say_what_the_list_says(seed: int) -> None:
    described = crowd(seed, 12, compounds=True)
    cell = config(resolved({f"body_{k}": one for k, one in enumerate(described)}))
    bodies = list(cell.scene.bodies.values())
    scene = build(cell, FRICTION._replace(shape_pairs=tuple(sorted(SHAPE_PAIRS))))
    material = scene.bodies["material"]
    listed = candidate_pairs(bodies)
    for pair in listed:
        first, second = sorted((pair.a, pair.b))
        template = scene.templates[material[first], material[second]]
        assert template["kind"] == SHAPE_PAIRS[pair.shape_pair].kind
        assert template["swap"] == (pair.a > pair.b)
        for name in ("friction", "restitution", "compliance"):
            assert template[name] == getattr(pair.surface, name)
    # What the list leaves out for what it is, not for whose part it is, has no template.
    known = {tuple(sorted((p.a, p.b))) for p in listed}
    rows = colliders(bodies)
    for i in range(len(rows)):
        for j in range(i + 1, len(rows)):
            if (i, j) not in known and rows[i].owner != rows[j].owner:
                assert scene.templates[material[i], material[j]]["kind"] < 0


def test_parts_of_one_body_are_no_pair() -> None:
    parts = [{"shape": KINDS[0]}, {"shape": KINDS[0], "position": [1, 0, 0]}]
    (thing,) = bodies_of(body({"kind": "compound", "parts": parts}))
    assert candidate_pairs([thing]) == []
    assert class_pairs(colliders([thing])) == []
    pairs = candidate_pairs([thing, thing])
    assert sorted((pair.a, pair.b) for pair in pairs) == [(2, 4), (2, 5), (3, 4), (3, 5)]


def test_ten_thousand_bodies_are_planned_by_their_classes() -> None:
    spheres = {f"s{k}": sphere(0.1, (0, 0, k), friction=0.5) for k in range(10_000)}
    bodies = {"floor": plane(friction=0.5), **spheres, "box": box((1, 1, 1), (0, 0, -5))}
    cell = config(resolved(bodies))
    facts = facts_of(cell)
    # 10,000 with each other, the floor with 10,001, the box with 10,000
    assert facts.pair_count == math.comb(10_000, 2) + 10_001 + 10_000
    assert [(p.a, p.b) for p in facts.pairs] == [
        ("floor", "s0"), ("floor", "box"), ("s0", "s1"), ("box", "s0"),
    ]  # fmt: skip
    assert len(classes_of(colliders(list(cell.scene.bodies.values())))[0]) == 3
    assert plan_of(cell).spec.shape_pairs == (
        "box_plane", "sphere_box", "sphere_plane", "sphere_sphere",
    )  # fmt: skip
