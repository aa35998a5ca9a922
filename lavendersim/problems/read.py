"""Reading of contact problems from files and folders, in the format that their first bytes show."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from lavendersim.engine.contact_problem import ContactProblem
from lavendersim.errors import ProblemError

SUFFIXES = (".dat", ".hdf5", ".h5")


class Readings(NamedTuple):
    """What files and folders had."""

    problems: list[tuple[str, ContactProblem]]  # by name, without folder where that is clear
    unreadable: list[str]  # a sentence of each file of a folder that is no problem, or is damaged


def problem_files(paths: Iterable[Path]) -> dict[Path, bool]:
    """Return every file once, in order, and whether it was named itself.

    A folder stands for the files within it that are named like problems. Raises ProblemError for a
    path that does not exist and a folder that holds none.
    """
    files: dict[Path, bool] = {}
    for path in map(Path, paths):
        if not path.exists():
            raise ProblemError(f"{path}: no such file or folder")
        if not path.is_dir():
            files[path] = True
            continue
        within = sorted(p for p in path.rglob("*") if p.suffix in SUFFIXES and p.is_file())
        if not within:
            raise ProblemError(f"{path}: expected problem files ({', '.join(SUFFIXES)}) in it")
        for file in within:
            files.setdefault(file, False)
    return files


def read_all(paths: Iterable[Path]) -> Readings:
    """Read every file among `paths`; of a folder what can be read, and the rest is named.

    Raises ProblemError, with a sentence for every bad file, where one of them was named itself, or
    where no file can be read.
    """
    files = problem_files(paths)
    alike = Counter(file.name for file in files)
    problems, unreadable, is_refused = [], [], False
    for file, is_named in files.items():
        try:
            name = file.name if alike[file.name] == 1 else str(file)
            problems.append((name, read_problem(file)))
        except ProblemError as error:
            unreadable.append(str(error))
            is_refused = is_refused or is_named
    if is_refused or not problems:
        raise ProblemError("\n".join(unreadable))
    return Readings(problems, unreadable)


def read_problem(file: Path) -> ContactProblem:
    """Read a problem in Siconos' or FCLIB's format, distinguished by the first bytes of the file.

    Raises ProblemError, one sentence, where the file is neither or is damaged.
    """
    # The two bring scipy and h5py: each loads when the first file of its kind comes.
    from lavendersim.problems.fclib import SIGNATURE, read_fclib
    from lavendersim.problems.siconos import read_siconos

    file = Path(file)
    with file.open("rb") as opened:
        first = opened.read(len(SIGNATURE))
    return read_fclib(file) if first == SIGNATURE else read_siconos(file)
