"""The defects of one file, each place reported once, in the order of the file."""

from __future__ import annotations

from lavendersim.errors import Defect
from lavendersim.experiment.text.node import Mark

MOST_DEFECTS = 200  # nobody reads further, and printing more takes longer than finding them


class Report:
    """Collects defects in rounds; a place that an earlier round refused is not refused again.

    One round is the text, the file as written, or one cell of its sweep: cells share most of their
    nodes, so the same mistake is found in each of them.
    """

    def __init__(self, name: str) -> None:
        self.name = name
        self._defects: list[Defect] = []
        self._reported: set[Mark] = set()
        self._round: dict[tuple[Mark, str], None] = {}
        self._sound = True  # nothing found in this round, new or reported before

    def add(self, mark: Mark, message: str) -> None:
        """Note a defect of the current round."""
        self._sound = False
        if mark not in self._reported:
            self._round[mark, message] = None

    def doubt(self) -> None:
        """Note that something is wrong that was reported already, perhaps at another place."""
        self._sound = False

    def close_round(self) -> bool:
        """End the round; tells whether nothing was found in it, be it new or reported before."""
        self._defects += [mark.defect(self.name, sentence) for mark, sentence in self._round]
        self._reported |= {mark for mark, _ in self._round}
        self._round.clear()
        sound, self._sound = self._sound, True
        return sound

    def _order(self, defect: Defect) -> tuple[str, int, int]:
        own = defect.file == self.name or defect.file.startswith("--")
        return "" if own else defect.file, defect.line, defect.column

    @property
    def defects(self) -> tuple[Defect, ...]:
        """All defects in the order of the file, those of files that it extends behind them.

        A very long list ends with how many are left.
        """
        self.close_round()
        ordered = sorted(self._defects, key=self._order)
        if len(ordered) <= MOST_DEFECTS:
            return tuple(ordered)
        last = ordered[MOST_DEFECTS - 1]
        more = f"... and {len(ordered) - MOST_DEFECTS + 1} more defects from here on"
        return (*ordered[: MOST_DEFECTS - 1], last._replace(message=more))
