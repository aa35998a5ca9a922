"""docs/gallery.md is that of the scenes in tests/gallery: a picture each, and none left over."""

from __future__ import annotations

import pytest
from gallery_page import PAGE, PICTURES, SECTIONS, drawn, not_yet, page, scenes, section

MOST = 15_000  # bytes of a picture


def test_the_page_is_made_from_the_scenes() -> None:
    """`python tests/rules/gallery_page.py` writes it anew."""
    assert PAGE.read_text() == page()


def test_every_scene_is_on_it_once_with_its_question_and_file() -> None:
    text = PAGE.read_text()
    for file in scenes():
        assert text.count(f"images/gallery/{file.stem}.png") == 1
        assert text.count(f"(../tests/gallery/{file.stem}.yaml)") == 1
    for file in not_yet():
        assert text.count(f"| `{file.stem}` |") == 1


def test_every_scene_has_a_small_picture_and_no_picture_is_left_over() -> None:
    assert sorted(PICTURES.glob("*.png")) == [drawn(file) for file in scenes()]
    assert [one.name for one in PICTURES.glob("*.png") if one.stat().st_size > MOST] == []


@pytest.mark.parametrize(
    ("more", "title"),
    [
        ({"scene": {}}, "Balls"),
        ({"scene": {"gravity": 0}}, "Without gravity"),
        ({"scene": {"forces": []}}, "Pushed, carried and changed"),
        ({"scene": {}, "events": []}, "Pushed, carried and changed"),
        ({"scene": {"springs": [], "forces": []}}, "Joints, ropes and springs"),
    ],
)
def test_a_scene_stands_in_the_first_section_that_fits(more: dict, title: str) -> None:
    ball = {"shape": {"kind": "sphere", "radius": 0.1}, "mass": 1.0}
    scene = {"bodies": {"floor": {"shape": {"kind": "plane"}}, "ball": ball}, **more["scene"]}
    assert section({**more, "scene": scene}) == title
    assert title in SECTIONS
