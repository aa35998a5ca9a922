"""Looks of series: distinguished in colour and in grey, and a scale whose lightness rises."""

from __future__ import annotations

from lavendersim.figures.style import LOOKS, look, sequential


def grey(colour: str) -> float:
    """Return the lightness of a colour (Rec. 709), 0 to 255."""
    red, green, blue = (int(colour[k : k + 2], 16) for k in (1, 3, 5))
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def test_every_look_has_a_colour_and_a_marker_of_its_own() -> None:
    assert len({one.colour for one in LOOKS}) == len({one.marker for one in LOOKS}) == len(LOOKS)
    assert look(len(LOOKS) + 2) == LOOKS[2]


def test_a_scale_grows_lighter_with_its_rank_from_end_to_end() -> None:
    for count in (2, 6, 40):
        shown = [sequential(rank, count) for rank in range(count)]
        lightness = [grey(one.colour) for one in shown]
        assert lightness == sorted(lightness)
        assert len(set(lightness)) == count
        assert [shown[0].colour, shown[-1].colour] == ["#00224E", "#C3B369"]
        assert [one.named for one in shown].count(True) == min(count, 3)
