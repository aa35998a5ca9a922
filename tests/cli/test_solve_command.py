"""`lavender solve`: what it prints, draws and exits with."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest
from command_line import lavender

OUTSIDE = os.environ.get("LAVENDER_CONTACT_PROBLEMS", "")
IDENTITY = "0 3 3 3 3\n1 0 0 0 1 0 0 0 1\n"
# A unit mass that closes at 2 m/s and slides at 5 m/s: r = (2, -0.6, -0.8) at mu = 0.5.
SLIDES = f"3 1\n{IDENTITY}-2 3 4\n0.5\n"
# Two contacts of one mass, pushed by both: no solver is done after one sweep.
COUPLED = (
    "3 2\n0 6 6 6 6\n"
    "2 0.3 0 1.5 0 0.2\n0.3 1 0 0 0.4 0\n0 0 1 0.2 0 0.1\n"
    "1.5 0 0.2 2 0.1 0\n0 0.4 0 0.1 1 0\n0.2 0 0.1 0 0 1\n"
    "-1 0.5 0.2 -2 0.1 0.7\n0.3 0.6\n"
)


@pytest.fixture
def where(tmp_path: Path) -> Path:
    (tmp_path / "slides.dat").write_text(SLIDES)
    (tmp_path / "coupled.dat").write_text(COUPLED)
    return tmp_path


def strict(text: str):
    """Read JSON as other languages do: it has no NaN and no Infinity."""

    def refuse(word: str) -> None:
        raise AssertionError(f"{word} is not JSON")

    return json.loads(text, parse_constant=refuse)


def test_a_solved_problem_is_reported_in_a_table(where: Path) -> None:
    done = lavender("solve", "slides.dat", where=where)
    assert done.returncode == 0, done.stderr
    title, header, row = done.stdout.splitlines()
    assert title == "slides.dat: 1 contact, tolerance 1e-08"
    assert header.split() == ["solver", "status", "scaled", "local", "sweeps", "time"]
    name, status, scaled, *_ = row.split()
    assert (name, status) == ("auto", "solved")
    assert float(scaled) <= 1e-8


def test_a_folder_stands_for_its_files_and_figures_are_drawn(where: Path) -> None:
    (where / "notes.txt").write_text("no problem")
    done = lavender(
        "solve", ".", "--solver", "auto, projected_gauss_seidel", "--plot", "drawn", "--json",
        where=where,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    report = strict(done.stdout)
    assert [one["name"] for one in report["problems"]] == ["coupled.dat", "slides.dat"]
    for one in report["problems"]:
        assert one["solved"]
        assert [each["solver"] for each in one["attempts"]] == ["auto", "projected_gauss_seidel"]
        for each in one["attempts"]:
            assert each["residual"]["scaled"] <= report["tolerance"]
            assert each["timing"]["median"] > 0.0
            assert each["points"][0]["budget"] == 1
    names = [Path(figure).name for figure in report["figures"]]
    stems = ("residual_against_time", "performance_profile")
    assert names == [f"{stem}.{suffix}" for stem in stems for suffix in ("png", "svg")]
    assert all((where / figure).stat().st_size > 5000 for figure in report["figures"])


def test_a_problem_that_is_not_solved_exits_1_and_says_what_is_missed(where: Path) -> None:
    done = lavender(
        "solve", "coupled.dat", "slides.dat", "--sweeps", 1, "-s", "projected_gauss_seidel",
        where=where,
    )  # fmt: skip
    assert done.returncode == 1
    coupled, slides = done.stdout.split("slides.dat:")
    assert "all sweeps spent" in coupled
    assert "projected_gauss_seidel misses: " in coupled
    assert " m/s at contact " in coupled
    assert " solved " in slides


def test_files_of_one_name_are_distinguished(where: Path) -> None:
    (where / "other").mkdir()
    (where / "other" / "slides.dat").write_text(SLIDES)
    done = lavender("solve", "slides.dat", "other", "-s", "projected_gauss_seidel", where=where)
    titles = [line for line in done.stdout.splitlines() if not line.startswith(" ")]
    assert [title.partition(":")[0] for title in titles] == ["slides.dat", "other/slides.dat"]


@pytest.mark.skipif(
    not OUTSIDE, reason="LAVENDER_CONTACT_PROBLEMS does not say where problems of others are"
)
def test_every_problem_of_others_is_solved_unasked_how(tmp_path: Path) -> None:
    done = lavender("solve", OUTSIDE, "--json", where=tmp_path)
    assert done.returncode == 0, done.stderr
    for problem in strict(done.stdout)["problems"]:
        (attempt,) = problem["attempts"]
        assert (attempt["solver"], attempt["solved"]) == ("auto", True)
        assert attempt["residual"]["scaled"] <= 1e-8


def test_every_bad_file_is_reported_before_anything_is_solved(where: Path) -> None:
    (where / "short.dat").write_text(SLIDES[:-5])
    (where / "plane.dat").write_text("2 1 0 2 2 2 2 1 0 0 1 1 1 0.5")
    done = lavender("solve", "slides.dat", "short.dat", "plane.dat", where=where)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.splitlines() == [
        "short.dat:4: expected mu, a number, but the file ends after 0",
        'plane.dat:1:1: expected a problem of dimension 3, not 2, found "2"',
    ]


def test_of_a_folder_what_can_be_read_is_solved_and_the_rest_is_named(where: Path) -> None:
    (where / "short.dat").write_text(SLIDES[:-5])
    (where / "not_one.hdf5").write_bytes(b"\x00\x01 no problem")
    done = lavender("solve", ".", "-s", "projected_gauss_seidel", where=where)
    titles = [line for line in done.stdout.splitlines() if not line.startswith(" ")]
    assert [title.partition(":")[0] for title in titles] == ["coupled.dat", "slides.dat"]
    left_out = [line for line in done.stderr.splitlines() if line.startswith("left out: ")]
    assert [line.split()[2].partition(":")[0] for line in left_out] == ["not_one.hdf5", "short.dat"]
    assert "2 of 4 files could not be read" in done.stderr
    assert done.returncode == 3
    as_data = lavender("solve", ".", "--json", where=where)
    assert (as_data.returncode, len(strict(as_data.stdout)["unreadable"])) == (3, 2)


def test_a_bad_file_that_is_named_is_refused_though_its_folder_is_too(where: Path) -> None:
    (where / "short.dat").write_text(SLIDES[:-5])
    for arguments in ((".", "short.dat"), ("short.dat", ".")):
        done = lavender("solve", *arguments, where=where)
        assert (done.returncode, done.stdout) == (2, "")
        assert done.stderr.startswith("short.dat:4: ")


def test_a_folder_of_which_nothing_can_be_read_is_refused(tmp_path: Path) -> None:
    (tmp_path / "short.dat").write_text(SLIDES[:-5])
    done = lavender("solve", ".", where=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("short.dat:4: ")


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (
            ("slides.dat", "-s", "projected_gaus_seidel"),
            'no solver is called "projected_gaus_seidel"; did you mean "projected_gauss_seidel"?\n',
        ),
        (("nowhere.dat",), "nowhere.dat: no such file or folder\n"),
        (("empty",), "empty: expected problem files (.dat, .hdf5, .h5) in it\n"),
        (("slides.dat", "--tolerance", "0"), "--tolerance 0: expected a number above 0\n"),
        (("slides.dat", "--tolerance", "nan"), "--tolerance nan: expected a number above 0\n"),
    ],
)
def test_what_cannot_be_asked_exits_2(where: Path, arguments: tuple, sentence: str) -> None:
    (where / "empty").mkdir()
    done = lavender("solve", *arguments, where=where)
    assert (done.returncode, done.stdout, done.stderr) == (2, "", sentence)
