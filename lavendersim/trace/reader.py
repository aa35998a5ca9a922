"""The reader of logs: columns, each loaded when it is first asked for.

Reading `step` or `residual` touches the light chunks only, `pose` its own, and `contact` its own;
but of a log whose contacts are expected by where its spheres are, those of poses as well.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from fractions import Fraction
from functools import cached_property, lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lavendersim.cell import AnyEvent, CellConfig, happened, met_after
from lavendersim.errors import OtherVersionError, TraceError, unanswerable
from lavendersim.record_tables import joined
from lavendersim.trace import decode, layout
from lavendersim.trace.absent import absent_table, table_without
from lavendersim.trace.contact_columns import known_rules
from lavendersim.trace.forms import RULES
from lavendersim.trace.index import ChunkContent, damage
from lavendersim.trace.limits import clock_of, names_of, reasons_of
from lavendersim.trace.positions import Positions
from lavendersim.trace.recorded import KEYS, RECORDED, is_recorded, partly_recorded
from lavendersim.trace.schema import (
    FORMAT,
    FORMER_NOT_REPORTED,
    RESIDUAL_COLUMNS,
    STEP_COLUMNS,
    Column,
)
from lavendersim.trace.source import Source
from lavendersim.trace.streams import COLUMNS
from lavendersim.trace.whole import INTERRUPTED
from lavendersim.trace.writer import (
    ABSENT,
    DESCRIPTION,
    ENDING,
    NOT_REPORTED_COLUMNS,
    TIMESTEP_CHANGES,
)

if TYPE_CHECKING:
    from lavendersim.arrow import Table

COMPLETE = "complete"
INCOMPLETE = "incomplete"
# Of contacts that take up to so many bytes parts are kept for the next measure: what a log holds in
# memory does not grow with it.
KEPT_BYTES = 8 * 1024 * 1024
MOST_SHOWN = 8  # names of bodies, to a person who looks at a trace
RECOVERED = "recovered"  # how the status of a log begins that `recover` made of a part of one


class RecordedPoses(NamedTuple):
    """The poses that a log has, of every step or of some."""

    rows: NDArray[np.intp]  # of `step`
    pose: NDArray[np.float64]  # (rows, bodies, 7)


class Trace:
    """One run's log. The columns and their units stand in `schema`.

    status: how the run ended, as its log says: `complete`, diverged, stopped by a bound,
        interrupted.
    damage: a sentence where this is not all that was written of it; empty where it is.
    """

    def __init__(
        self, path: Path, source: Source, damaged: str = "", config: CellConfig | None = None
    ) -> None:
        """damaged: why this is a part of a log that was not closed or has changed since."""
        self.path = path
        self.damage = damaged
        if config is not None:
            self.config = config
        self._source = source
        self._kept: list[NDArray[Any]] | None = None  # contacts in parts, of a log of not too many
        with damage(path, "the metadata"):
            self.metadata = source.metadata()
            description = self.metadata[DESCRIPTION]
            if description["format"] != FORMAT:
                raise TraceError(
                    f"{path}: log format {description['format']}, this version reads {FORMAT}"
                )
            self.bodies = [*_names(description["bodies"])]
            self.clock = clock_of(description["timestep"], description.get(TIMESTEP_CHANGES, "[]"))
            # topic -> why this log does without it; logs before there was a choice have them all
            self.absent = {**_reasons(description.get(ABSENT, "{}"))}
            if source.schema(layout.CHANNELS["/velocities"]) is None:  # nor in older logs
                self.absent.setdefault("/velocities", "record.velocities is false")
            # topic -> of which steps alone it has it; those are in `recorded_pose` and so on
            partly = partly_recorded(self.metadata.get(RECORDED, {}))
            self.partly = {t: why for t, why in partly.items() if t not in self.absent}
            self.absent |= self.partly
            self.status = INCOMPLETE if damaged else self.metadata[ENDING]["status"]
        if self.status.startswith((RECOVERED, INTERRUPTED)):
            self.damage = f"{path}: {self.status}"
        self.complete = self.status == COMPLETE

    def __repr__(self) -> str:
        """What it is of, without reading a column: status, timestep, bodies, absent topics."""
        shown = ", ".join(self.bodies[:MOST_SHOWN]) + (", ..." * (len(self.bodies) > MOST_SHOWN))
        lines = [f"Trace of {self.path}: {self.status}"]
        lines += [f"  steps of {self.clock.timestep} s; {len(self.bodies)} bodies: {shown}"]
        lines += [f"  without {topic}: {why}" for topic, why in self.absent.items()]
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        """Return the log as a notebook shows it."""
        from lavendersim.trace.shown_log import html_of  # late: reading needs none of it

        return html_of(self)

    def verify(self) -> None:
        """Raise TraceError unless every byte is as written; the first column read asks, too."""
        self._source.verify()

    @property
    def timestep(self) -> Fraction:
        """Length of the first step [s]."""
        return self.clock.timestep

    @cached_property
    def timesteps(self) -> NDArray[np.float64]:
        """Length [s] of the step that ends in each row of `step`; of step 0, that of the first."""
        return self.clock.lengths(self.step["step"])

    @cached_property
    def step(self) -> NDArray[Any]:
        """One row per logged step: the file's columns, and `time` [s]."""
        with damage(self.path, "/step"):
            step = decode.join(self.steps_in_parts(), decode.step_columns(self.step_columns))
        return table_without(step, self._not_reported("/step"))

    @property
    def step_columns(self) -> tuple[Column, ...]:
        """The columns of `step` that the file has; `time` [s] follows from them."""
        return self._columns("/step", "Step", STEP_COLUMNS)

    def steps_in_parts(self) -> Iterator[NDArray[Any]]:
        """Yield the rows of `step` in parts, read as they are asked for and not kept."""
        if "step" in self.__dict__:  # read already
            yield self.step
            return
        with damage(self.path, "/step"):
            columns = self.step_columns
            for chunk in self._chunks("/step"):
                yield decode.decode_steps(chunk, columns)

    @cached_property
    def residual(self) -> NDArray[Any]:
        """One row per sweep of the steps that were asked for: step, sweep, residual [m/s].

        Without /residuals an empty table, which gives the reason where a column is asked of it.
        """
        if "/residuals" in self.absent:
            return absent_table(self.why_not("/residuals"))
        with damage(self.path, "/residuals"):
            columns = self._columns("/residuals", "Sweep", RESIDUAL_COLUMNS)
            parts = [decode.decode_residuals(c, columns) for c in self._chunks("/residuals")]
            return decode.join(parts, decode.residual_columns(columns))

    @cached_property
    def pose(self) -> NDArray[np.float64]:
        """Poses (rows, bodies, 7): x y z [m], qw qx qy qz; the same rows as `step`.

        UsageError for a log without /tf, or of some steps alone.
        """
        if "/tf" in self.absent:
            raise unanswerable(self.why_not("/tf"))
        return self.recorded_pose.pose

    @cached_property
    def recorded_pose(self) -> RecordedPoses:
        """The poses of the steps of which the log has them. UsageError for a log without /tf."""
        if not self.has("/tf"):
            raise unanswerable(self.why_not("/tf"))
        with damage(self.path, "/tf"):
            parts = list(self.poses_in_parts())
            steps = np.concatenate([np.empty(0, np.int64), *(steps for steps, _ in parts)])
            rows = self.recorded_rows("/tf")
            if not np.array_equal(steps, self.step["step"][rows]):
                raise ValueError("it has other steps than it should")
            empty = np.empty((0, len(self.bodies), layout.POSE))
            return RecordedPoses(rows, np.concatenate([empty, *(poses for _, poses in parts)]))

    def poses_in_parts(self) -> Iterator[tuple[NDArray[np.int64], NDArray[np.float64]]]:
        """Yield recorded poses (rows, bodies, 7) with the numbers of their steps, and keep none."""
        if not self.has("/tf"):
            raise unanswerable(self.why_not("/tf"))
        with damage(self.path, "/tf"):
            form, count = layout.transforms_layout(self.bodies), len(self.bodies)
            for chunk in self._chunks("/tf"):
                yield decode.decode_poses(chunk, form, count)

    @cached_property
    def velocity(self) -> NDArray[np.float64]:
        """Velocities (rows, bodies, 6): vx vy vz [m/s], wx wy wz [rad/s]; the same rows as `step`.

        UsageError for a log without /velocities, or of some steps alone.
        """
        for topic in ("/velocities", "/tf"):
            if topic in self.absent:
                raise unanswerable(self.why_not(topic))
        with damage(self.path, "/velocities"):
            parts = list(self.velocities_in_parts())
            steps = np.concatenate([np.empty(0, np.int64), *(steps for steps, _ in parts)])
            if not np.array_equal(steps, self.step["step"]):
                raise ValueError("it has other steps than it should")
            empty = np.empty((0, len(self.bodies), layout.VELOCITY))
            return np.concatenate([empty, *(velocities for _, velocities in parts)])

    def velocities_in_parts(self) -> Iterator[tuple[NDArray[np.int64], NDArray[np.float64]]]:
        """Yield recorded velocities (rows, bodies, 6) with the numbers of their steps; keep none.

        Of the steps whose poses are recorded.
        """
        if not self.has("/velocities"):
            raise unanswerable(self.why_not("/velocities"))
        with damage(self.path, "/velocities"):
            form, count = layout.velocities_layout(self.bodies), len(self.bodies)
            for chunk in self._chunks("/velocities"):
                yield decode.decode_velocities(chunk, form, count)

    def recorded_rows(self, topic: str) -> NDArray[np.intp]:
        """Return the rows of `step` of which the log has a topic, /tf or /contacts."""
        steps = self.step["step"]
        if topic not in self.partly:
            return np.arange(len(steps))
        return np.flatnonzero(
            is_recorded(getattr(self.config.record, KEYS[topic]), self.clock, steps)
        )

    def has(self, topic: str) -> bool:
        """Tell whether the log has a topic, of every step or of some."""
        return topic not in self.absent or topic in self.partly

    @cached_property
    def contact(self) -> NDArray[Any]:
        """One row per contact and step: `step`, the file's columns, and `time` [s].

        Without /contacts, or with those of some steps alone, an empty table, which gives the
        reason where a column is asked of it.
        """
        if "/contacts" in self.absent:
            return absent_table(self.why_not("/contacts"))
        return table_without(self.recorded_contact, self._not_reported("/contacts"))

    @cached_property
    def recorded_contact(self) -> NDArray[Any]:
        """Like `contact`, of the steps of which the log has them; see `recorded_rows`."""
        if not self.has("/contacts"):
            return absent_table(self.why_not("/contacts"))
        kept, self._kept = self._kept, None
        parts = list(self.recorded_contacts_in_parts()) if kept is None else kept
        if not parts:
            return decode.join((), [("step", "i8"), ("time", "f8")])
        return joined(parts)

    def contacts_in_parts(self) -> Iterator[NDArray[Any]]:
        """Yield the rows of `contact` in parts of whole steps, read as they are asked for.

        A long run of many bodies has more of them than memory holds; of others they are kept for
        whoever asks again. None without /contacts, or with those of some steps alone.
        """
        if "/contacts" in self.absent:
            return
        not_reported = self._not_reported("/contacts")
        if "recorded_contact" in self.__dict__:  # read already
            yield table_without(self.recorded_contact, not_reported)
            return
        if self._kept is not None:
            yield from (table_without(part, not_reported) for part in self._kept)
            return
        kept: list[NDArray[Any]] = []
        size = 0
        for part in self.recorded_contacts_in_parts():
            size += part.nbytes
            kept = [*kept, part] if size <= KEPT_BYTES else []
            yield table_without(part, not_reported)
        if size <= KEPT_BYTES:
            self._kept = kept

    def recorded_contacts_in_parts(self) -> Iterator[NDArray[Any]]:
        """Yield the rows of `recorded_contact` in parts of whole steps, and keep none."""
        if not self.has("/contacts"):
            raise unanswerable(self.why_not("/contacts"))
        schema = self._source.schema(layout.CHANNELS[COLUMNS])
        if schema is None:
            yield from self._contacts_of_points()
            return
        with damage(self.path, COLUMNS):
            derived = self._derived()
            around = decode.AroundContacts(self.clock, Positions(self._poses_at_hand()))
            for chunk in self._chunks(COLUMNS):
                yield decode.decode_columns(chunk, schema, derived, around)

    def _poses_at_hand(self) -> Iterator[tuple[NDArray[np.int64], NDArray[np.float64]]]:
        """Yield poses as `poses_in_parts`; what was read already is not read again."""
        if "recorded_pose" in self.__dict__:
            rows, pose = self.recorded_pose
            yield self.step["step"][rows], pose
            return
        yield from self.poses_in_parts()

    def _contacts_of_points(self) -> Iterator[NDArray[Any]]:
        """Yield the contacts of a log whose points are all that it has of them, as older ones."""
        with damage(self.path, "/contacts"):
            frame = layout.root_frame(self.bodies)
            fields: tuple[layout.PackedField, ...] = ()
            stride = 0
            for chunk in self._chunks("/contacts"):
                schema = self._source.schema(layout.CHANNELS["/contacts"])
                if not fields and schema is not None:
                    fields, stride = decode.packed_fields(schema, chunk)
                yield decode.decode_contacts(chunk, fields, stride, frame)

    def table(self, name: str) -> Table:
        """Return `step`, `pose`, `velocity` or `contact` for Arrow; UsageError without it."""
        from lavendersim.trace.tables import table_of  # late: reading needs no Arrow

        return table_of(self, name)

    def why_not(self, topic: str) -> str:
        """Return the reason why this log has no such topic, or not all of it, as a sentence."""
        if topic in self.partly:
            return f"{self.path}: this log has not every step of {topic}: {self.partly[topic]}"
        return f"{self.path}: this log has no {topic}: {self.absent[topic]}"

    @cached_property
    def as_written(self) -> str:
        """The config file as its author wrote it."""
        return self._source.as_written()

    @cached_property
    def config(self) -> CellConfig:
        """The config of this cell with every default filled in.

        TraceError where another version wrote it so that this one cannot read it.
        """
        return self._source.config()

    def config_data(self) -> dict[str, Any]:
        """Return the config of this cell as plain data, of whatever version it is."""
        try:
            return dict(json.loads(self.config.as_json()))
        except OtherVersionError:
            return self._source.config_data()

    @cached_property
    def events(self) -> tuple[AnyEvent, ...]:
        """The events of the run at their times; of those with a trigger, what was met, and when."""
        triggered = self.config.triggered
        met = met_after(self.steps_in_parts()) if triggered else {}
        return happened(self.config.events, triggered, met, self.clock)

    def _not_reported(self, topic: str) -> dict[str, str]:
        """Return the columns of a topic that the engine does not report, with sentences."""
        keys = NOT_REPORTED_COLUMNS, FORMER_NOT_REPORTED
        reasons = next((self.metadata[key] for key in keys if key in self.metadata), {})
        return {
            name.removeprefix(f"{topic}."): f"this log has no {name}: {why}"
            for name, why in reasons.items()
            if name.startswith(f"{topic}.")
        }

    def _columns(self, topic: str, message: str, default: tuple[Column, ...]) -> tuple[Column, ...]:
        """Return the columns of a topic; a run that ended before its first step has `default`."""
        schema = self._source.schema(layout.CHANNELS[topic])
        return default if schema is None else decode.columns_in(schema, message)

    def _derived(self) -> tuple[str, ...]:
        """Return the columns of contacts that rules give back; of older logs, none."""
        described = self._source.described(layout.CHANNELS[COLUMNS])
        rules = json.loads(described.get(RULES, "{}"))
        try:
            return known_rules(rules)
        except ValueError as error:
            raise TraceError(f"{self.path}: {error}") from None

    def _chunks(self, topic: str) -> Iterator[ChunkContent]:
        return self._source.chunks(layout.CHANNELS[topic])


@lru_cache(maxsize=64)  # the logs of a sweep mostly have the same
def _names(bodies: str) -> list[str]:
    return names_of(json.loads(bodies))


@lru_cache(maxsize=64)
def _reasons(absent: str) -> dict[str, str]:
    return reasons_of(json.loads(absent))
