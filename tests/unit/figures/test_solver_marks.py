"""How solvers look: alike on every page, dashed once colours are used up; repeats in words."""

from __future__ import annotations

from lavendersim.figures.solver_marks import marks, page_of_solvers, plain, span
from lavendersim.figures.style import LOOKS

SOLVERS = [f"solver_{k}" for k in range(len(LOOKS) + 2)]


def test_a_solver_looks_like_no_other() -> None:
    looks = [marks(SOLVERS, name) for name in SOLVERS]
    seen = {(one["color"], one["marker"], str(one["linestyle"])) for one in looks}
    assert len(seen) == len(looks)
    assert looks[0]["linestyle"] == "-"
    assert looks[len(LOOKS)]["color"] == looks[0]["color"]
    assert looks[len(LOOKS)]["linestyle"] != "-"


def test_its_name_is_read_in_words() -> None:
    assert plain("projected_gauss_seidel") == "projected gauss seidel"


def test_repeats() -> None:
    assert span([]) == span([1]) == "1 repeat"
    assert span([3, 3]) == "3 repeats"
    assert span([5, 2]) == "2 to 5 repeats"


def test_the_legend_above_has_every_solver() -> None:
    figure = page_of_solvers(SOLVERS[:3], 6.0, 3.0, "what is shown")
    texts = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    assert sorted(texts) == ["solver 0", "solver 1", "solver 2"]
