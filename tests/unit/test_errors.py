"""Each kind of error has its exit code, and a defect says its place as editors read it."""

from __future__ import annotations

from lavendersim import errors
from lavendersim.errors import ConfigError, Defect, LavenderError


def test_a_defect_begins_with_its_place() -> None:
    assert str(Defect("a.yaml", 3, 5, "no such key")) == "a.yaml:3:5: no such key"


def test_a_config_error_has_a_line_for_each_defect_in_their_order() -> None:
    defects = [Defect("a.yaml", 9, 1, "one"), Defect("a.yaml", 2, 1, "other")]
    error = ConfigError(iter(defects))  # type: ignore[arg-type]
    assert error.defects == tuple(defects)
    assert str(error) == "a.yaml:9:1: one\na.yaml:2:1: other"


def test_exit_codes_are_those_of_docs() -> None:
    kinds = [one for one in vars(errors).values() if isinstance(one, type)]
    codes = {one.__name__: one.exit_code for one in kinds if issubclass(one, LavenderError)}
    asked = (
        *("UsageError", "NotReportedError", "ConfigError", "ProblemError"),
        "MissingDriverError",
    )
    assert codes == {
        **{"LavenderError": 4, "TraceError": 3, "OtherVersionError": 3},
        **dict.fromkeys(asked, 2),
    }


def test_reasons_of_older_logs_are_known_as_well() -> None:
    for sentence in ("no /step.sweeps: DART does not report it", "DART does not tell it"):
        assert errors.is_not_reported(sentence)
        assert isinstance(errors.unanswerable(sentence), errors.NotReportedError)
    assert not errors.is_not_reported("the log has no contacts")
