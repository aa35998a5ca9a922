"""Problems among files and folders: every file once, and what cannot be read is named."""

from __future__ import annotations

from pathlib import Path

import pytest

from lavendersim.errors import ProblemError
from lavendersim.problems import read
from lavendersim.problems.read import problem_files, read_all


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of problems whose texts are their names; a text `bad` is none."""
    for name in ("b.dat", "a.hdf5", "deep/c.h5", "deep/b.dat", "notes.txt"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(name)

    def read_problem(file: Path) -> str:
        text = file.read_text()
        if text == "bad":
            raise ProblemError(f"{file}: bad")
        return text

    monkeypatch.setattr(read, "read_problem", read_problem)
    return tmp_path


def test_a_folder_stands_for_its_problems_in_order(folder: Path) -> None:
    found = [str(file.relative_to(folder)) for file in problem_files([folder])]
    assert found == ["a.hdf5", "b.dat", "deep/b.dat", "deep/c.h5"]
    assert set(problem_files([folder]).values()) == {False}
    named = problem_files([folder / "b.dat", folder])
    assert next(iter(named.items())) == (folder / "b.dat", True)
    assert len(named) == 4


def test_names_stand_without_their_folder_where_that_is_clear(folder: Path) -> None:
    names = [name for name, _ in read_all([folder]).problems]
    assert names == ["a.hdf5", str(folder / "b.dat"), str(folder / "deep/b.dat"), "c.h5"]


def test_a_bad_file_of_a_folder_is_named_and_the_others_are_read(folder: Path) -> None:
    (folder / "a.hdf5").write_text("bad")
    found = read_all([folder])
    assert len(found.problems) == 3
    assert found.unreadable == [f"{folder / 'a.hdf5'}: bad"]


def test_a_bad_file_that_was_named_itself_ends_it(folder: Path) -> None:
    (folder / "a.hdf5").write_text("bad")
    with pytest.raises(ProblemError, match=r"a\.hdf5: bad"):
        read_all([folder / "a.hdf5", folder / "b.dat"])


def test_a_path_of_nothing_and_a_folder_without_problems(tmp_path: Path) -> None:
    with pytest.raises(ProblemError, match="no such file or folder"):
        problem_files([tmp_path / "none"])
    with pytest.raises(ProblemError, match=r"expected problem files \(\.dat, \.hdf5, \.h5\) in it"):
        problem_files([tmp_path])
