"""Reading of contact problems from files and folders, in the format that their first bytes show."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from pathlib import Path

from lavendersim.engine.contact_problem import ContactProblem
from lavendersim.errors import ProblemError

SUFFIXES = (".dat", ".hdf5", ".h5")


def problem_files(paths: Iterable[Path]) -> list[Path]:
    """Return every file once, in order; a folder stands for the problem files within it.

    Raises ProblemError for a path that does not exist and a folder that holds none.
    """
    files: dict[Path, None] = {}
    for path in map(Path, paths):
        if not path.exists():
            raise ProblemError(f"{path}: no such file or folder")
        if not path.is_dir():
            files[path] = None
            continue
        within = sorted(p for p in path.rglob("*") if p.suffix in SUFFIXES and p.is_file())
        if not within:
            raise ProblemError(f"{path}: expected problem files ({', '.join(SUFFIXES)}) in it")
        files.update(dict.fromkeys(within))
    return list(files)


def read_all(paths: Iterable[Path]) -> list[tuple[str, ContactProblem]]:
    """Read every file among `paths`; returns problems by name, without folder where that is clear.

    Raises ProblemError with a sentence for every file that is bad.
    """
    files = problem_files(paths)
    alike = Counter(file.name for file in files)
    problems, defects = [], []
    for file in files:
        try:
            name = file.name if alike[file.name] == 1 else str(file)
            problems.append((name, read_problem(file)))
        except ProblemError as error:
            defects.append(str(error))
    if defects:
        raise ProblemError("\n".join(defects))
    return problems


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
