"""Logs in; numbers, and verdicts on what was expected of them, out."""

from lavendersim.measures.always import outcomes_of
from lavendersim.measures.controls import meant_to_end_early
from lavendersim.measures.judge import judge, judge_nodes
from lavendersim.measures.registry import applies, evaluate
from lavendersim.measures.values import Values
from lavendersim.measures.verdict import Verdict

__all__ = [
    "Values",
    "Verdict",
    "applies",
    "evaluate",
    "judge",
    "judge_nodes",
    "meant_to_end_early",
    "outcomes_of",
]
