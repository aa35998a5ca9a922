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


def test_each_expectation_and_cell_is_an_item(pytester: pytest.Pytester) -> None:
    pytester.makefile(".yaml", drop=SWEPT)
    result = run(pytester, "--collect-only", "-q")
    result.stdout.fnmatch_lines(
        [
            "drop.yaml::every cell completes",
            "drop.yaml::rebound at e=0.5",
            "drop.yaml::rebound at e=0.9",
        ]
    )


def test_what_a_config_extends_is_part_of_it(pytester: pytest.Pytester) -> None:
    pytester.makefile(".yaml", _base=SWEPT, drop="extends: _base.yaml\nduration: 0.2\n")
    pytester.makefile(".yaml", lint="extends: recommended\n", other="extends: [a.yaml]\n")
    result = run(pytester, "--collect-only", "-q")
    result.stdout.fnmatch_lines(["drop.yaml::rebound at e=0.5"])
    result.stdout.no_fnmatch_line("*base.yaml*")
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


def test_an_effect_that_cannot_be_off_is_a_collection_error_with_its_place(
    pytester: pytest.Pytester,
) -> None:
    pytester.makefile(".yaml", drop=DROP + "effects: {gravity: off}\n")
    result = run(pytester)
    result.assert_outcomes(errors=1)
    line = len(DROP.splitlines()) + 1
    result.stdout.fnmatch_lines([f"*drop.yaml:{line}:11: effects.gravity: the scene requires it*"])
    result.stdout.no_fnmatch_line("*Traceback*")


def test_problems_that_cannot_be_written_are_a_collection_error(
    pytester: pytest.Pytester,
) -> None:
    pytester.makeconftest("import sys\nsys.modules['h5py'] = None  # as if not installed\n")
    pytester.makefile(".yaml", drop=DROP + "record: {problems: every 10}\n")
    result = run(pytester)
    result.assert_outcomes(errors=1)
    line = len(DROP.splitlines()) + 1
    result.stdout.fnmatch_lines([f"*drop.yaml:{line}:*: record.problems needs h5py: *"])
    result.stdout.no_fnmatch_line("*Traceback*")


def test_an_overhead_of_no_effect_is_a_collection_error(pytester: pytest.Pytester) -> None:
    pytester.makefile(".yaml", drop=DROP + "overhead: {effects: [drga]}\n")
    result = run(pytester)
    result.assert_outcomes(errors=1)
    line = len(DROP.splitlines()) + 1
    result.stdout.fnmatch_lines(
        [f"*drop.yaml:{line}:*: overhead.effects: no effect is called *drga*"]
    )
    result.stdout.no_fnmatch_line("*Traceback*")


def test_a_defective_config_is_a_collection_error_with_its_place(
    pytester: pytest.Pytester,
) -> None:
    pytester.makefile(".yaml", drop=DROP.replace("mass: 1.0", "mass: -1.0"))
    result = run(pytester)
    result.assert_outcomes(errors=1)
    result.stdout.fnmatch_lines(["*drop.yaml:8:*mass*"])


def test_an_accuracy_that_was_missed_is_said_and_fails_nothing(pytester: pytest.Pytester) -> None:
    # One sweep without a start leaves the lower of two stacked balls with half of g dt.
    low = "    low: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, position: [5, 0, 0.1]}\n"
    text = DROP.replace(
        "    ball:\n", low + low.replace("0.1]", "0.3]").replace("low", "high", 1) + "    ball:\n"
    )
    numerics = "{preset: chapter, sweeps: 1, warm_start: false, tolerance: 1e-9}"
    text = text.replace("numerics: chapter", f"numerics: {numerics}")
    pytester.makefile(".yaml", drop=text)
    result = run(pytester)
    result.assert_outcomes(passed=2)
    result.stdout.fnmatch_lines(
        [
            "*steps that did not converge*",
            "drop: * of 120 steps ended above the tolerance 1e-09 m/s*",
        ]
    )


def test_other_yaml_files_are_left_alone(pytester: pytest.Pytester) -> None:
    pytester.makefile(".yaml", compose="services:\n  scene: {image: x}\n")
    assert run(pytester).ret == pytest.ExitCode.NO_TESTS_COLLECTED


def test_a_diverged_cell_fails_even_where_nothing_is_expected(pytester: pytest.Pytester) -> None:
    text = DROP[: DROP.index("measure:\n")].replace(
        "mass: 1.0", "mass: 1.0\n      velocity: [1.0e+308, 0, 0]"
    )
    pytester.makefile(".yaml", drop=text.replace("duration: 0.5", "duration: 10"))
    result = run(pytester)
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["*diverged: body ball is no longer finite after step *"])


def test_pytest_takes_no_overheads(pytester: pytest.Pytester) -> None:
    pytester.makefile(".yaml", drop=DROP + "overhead: {effects: [drag]}\n")
    result = run(pytester, "--basetemp", str(pytester.path / "kept"))
    result.assert_outcomes(passed=2)
    (results,) = (pytester.path / "kept").rglob("results.json")
    assert "overheads" not in json.loads(results.read_text())
    assert not list((pytester.path / "kept").rglob("overheads.csv"))


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
