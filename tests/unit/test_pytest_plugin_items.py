"""pytest on config files: node ids, failure text, what is collected and what is left alone."""

from __future__ import annotations

import json

import pytest

from tests.drop_config import DROP

SWEPT = DROP.replace(
    "measure:\n",
    """sweep:
  e: {path: scene.bodies.ball.surface.restitution, values: [0.5, 0.9]}
measure:
""",
)


def run(pytester: pytest.Pytester, *arguments: str) -> pytest.RunResult:
    """Run pytest on a folder of somebody's own, outside any project."""
    return pytester.runpytest_subprocess("-p", "no:cacheprovider", *arguments)


def test_each_expectation_and_cell_of_an_experiment_is_an_item(
    pytester: pytest.Pytester,
) -> None:
    """What a config extends is part of it; what is no experiment is left alone."""
    pytester.makefile(".yaml", drop=SWEPT, compose="services:\n  scene: {image: x}\n")
    pytester.makefile(".yaml", _base=SWEPT, short="extends: _base.yaml\nduration: 0.2\n")
    pytester.makefile(".yaml", lint="extends: recommended\n", other="extends: [a.yaml]\n")
    result = run(pytester, "--collect-only", "-q")
    items = ("every cell completes", "rebound at e=0.5", "rebound at e=0.9")
    assert [line for line in result.outlines if "::" in line] == [
        f"{name}.yaml::{item}" for name in ("drop", "short") for item in items
    ]
    result.stdout.no_fnmatch_line("*rror*")


def test_a_failure_shows_measured_expected_tolerance_and_log(pytester: pytest.Pytester) -> None:
    pytester.makefile(".yaml", drop=SWEPT)
    result = run(pytester)
    result.assert_outcomes(passed=2, failed=1)
    result.stdout.fnmatch_lines(
        [
            "*rebound at e=0.9: FAILED*",
            "*measured   0.0*",
            "*expected   between 0.02 and 0.03*",
            "*tolerance *",
            "*log        *.mcap*",
        ]
    )
    result.stdout.no_fnmatch_line("*Traceback*")


def test_one_item_can_be_selected_by_its_id(pytester: pytest.Pytester) -> None:
    pytester.makefile(".yaml", drop=SWEPT)
    run(pytester, "drop.yaml::rebound at e=0.5").assert_outcomes(passed=1)


def test_a_defective_config_is_a_collection_error_with_its_place(
    pytester: pytest.Pytester,
) -> None:
    pytester.makeconftest("import sys\nsys.modules['h5py'] = None  # as if not installed\n")
    pytester.makefile(
        ".yaml",
        effect=DROP + "effects: {gravity: off}\n",
        mass=DROP.replace("mass: 1.0", "mass: -1.0"),
        overhead=DROP + "overhead: {effects: [drga]}\n",
        problems=DROP + "record: {problems: every 10}\n",
    )
    result = run(pytester)
    result.assert_outcomes(errors=4)
    line = len(DROP.splitlines()) + 1
    result.stdout.fnmatch_lines_random(
        [
            f"*effect.yaml:{line}:11: effects.gravity: the scene requires it*",
            "*mass.yaml:8:*mass*",
            f"*overhead.yaml:{line}:*: overhead.effects: no effect is called *drga*",
            f"*problems.yaml:{line}:*: record.problems needs h5py: *",
        ]
    )
    result.stdout.no_fnmatch_line("*Traceback*")


def test_what_is_missed_is_said_what_diverges_fails_and_no_overhead_is_taken(
    pytester: pytest.Pytester,
) -> None:
    # One sweep without a start leaves the lower of two stacked balls with half of g dt.
    low = "    low: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, position: [5, 0, 0.1]}\n"
    missed = DROP.replace(
        "    ball:\n", low + low.replace("0.1]", "0.3]").replace("low", "high", 1) + "    ball:\n"
    )
    numerics = "{preset: chapter, sweeps: 1, warm_start: false, tolerance: 1e-9}"
    missed = missed.replace("numerics: chapter", f"numerics: {numerics}")
    # Nothing is expected of it.
    diverges = DROP[: DROP.index("measure:\n")].replace(
        "mass: 1.0", "mass: 1.0\n      velocity: [1.0e+308, 0, 0]"
    )
    diverges = diverges.replace("duration: 0.5", "duration: 10")
    overhead = DROP + "overhead: {effects: [drag]}\n"
    pytester.makefile(".yaml", diverges=diverges, missed=missed, overhead=overhead)
    kept = pytester.path / "kept"
    result = run(pytester, "--basetemp", str(kept))
    result.assert_outcomes(passed=4, failed=1)
    result.stdout.fnmatch_lines_random(
        [
            "*diverged: body ball is no longer finite after step *",
            "*steps that did not converge*",
            "missed: * of 120 steps ended above the tolerance 1e-09 m/s*",
        ]
    )
    (results,) = kept.rglob("*-overhead-*/results.json")
    assert "overheads" not in json.loads(results.read_text())
    assert not list(kept.rglob("overheads.csv"))


def test_a_log_that_changed_before_it_was_measured_fails_its_expectation(
    pytester: pytest.Pytester,
) -> None:
    """Of a log too large to keep in memory the file is read."""
    pytester.makeconftest(
        """
        from lavendersim.trace import writer
        from lavendersim.trace.writer import TraceWriter

        writer.KEPT_BYTES = 0
        close = TraceWriter.close

        def spoil(self, status):
            written = close(self, status)
            data = bytearray(written.path.read_bytes())
            data[len(data) // 2] ^= 1
            written.path.write_bytes(data)
            return written

        TraceWriter.close = spoil
        """
    )
    pytester.makefile(".yaml", drop=DROP)
    result = run(pytester)
    result.assert_outcomes(passed=1, failed=1)
    result.stdout.fnmatch_lines(["*expected   a log that can answer*"])
    result.stdout.fnmatch_lines(["*because    *fail the CRC over all of them*"])
    result.stdout.no_fnmatch_line("*Traceback*")
