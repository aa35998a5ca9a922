"""An effect of a kind that there is, is its file and its name in one list.

Added to a copy of lavender, each in one file and one line: a wind, a cushion of air with a key of
the config and a column of the log, and a padding that changes what contacts' rows are made of.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from sources import ROOT

from tests.drop_config import DROP

LIST = "lavendersim/engine/effects/__init__.py"
WIND = '''\
"""Wind: a force c (u - v) of air that moves at u along x, on every movable body."""

from .decision import Decision
from .effect import Effect, Fields, Hooks, kernel

SPEED = 3.0  # u [m/s]


def body_values(body):
    return {"wind": 0.4}


def decide(facts):
    if facts.pairs:
        return Decision(True, f"{facts.pairs[0].b} stands in a wind of {SPEED:g} m/s")
    return Decision(False, "nothing stands in the wind")


def make(spec):
    def wind(body, velocity, params):
        velocity.vx += params.dt * body.inv_m * body.wind * (SPEED - velocity.vx)

    return kernel(wind, spec)


EFFECT = Effect(
    name="wind",
    decide=decide,
    per="body",
    fields=Fields(body=[("wind", "f8")]),  # c [N s/m]
    body_values=body_values,
    hooks=Hooks(accelerate=make),
)
'''
# An effect of another kind: a key of the config, a term of contacts, a column of the log.
CUSHION = '''\
"""Cushion: air between two surfaces that pushes them apart with a force F [N] while they touch."""

from .decision import Decision
from .effect import Column, Effect, Fields, Hooks, kernel
from .keys import FORCE, SurfaceKey, in_series


def decide(facts):
    for pair in facts.pairs:
        if pair.surface.cushion > 0.0:
            return Decision(True, f"{pair.a} and {pair.b}: a cushion of {pair.surface.cushion:g} N")
    return Decision(False, "no surface has a cushion")


def make_capture(spec):
    def keep_cushion(contact, pair, params):
        contact.loaded, contact.cushion = 1, pair.cushion * params.dt

    return kernel(keep_cushion, spec)


def make_preload(spec):
    from ..contact import make_apply_impulse

    apply_impulse = make_apply_impulse(spec)

    def push_apart(contact, velocities, motion):
        apply_impulse(contact, velocities[contact.a], velocities[contact.b], contact.cushion)

    return kernel(push_apart, spec)


def make_contact_row(spec):
    def log_cushion(out, contact, va, vb):
        out.cushion_impulse = contact.cushion

    return kernel(log_cushion, spec)


EFFECT = Effect(
    name="cushion",
    decide=decide,
    per="contact",
    surface_keys=(
        SurfaceKey(
            name="cushion", type=FORCE, default=0.0, doc="[N] what air carries", mix=in_series
        ),
    ),
    fields=Fields(
        pair=[("cushion", "f8")],  # F [N]
        contact=[("cushion", "f8"), ("loaded", "i8")],  # F dt [N s]
    ),
    contact_columns=(Column("cushion_impulse", "f8", "of the air on B along the normal", "N s"),),
    hooks=Hooks(capture=make_capture, preload=make_preload, contact_row=make_contact_row),
)
'''
# An effect that changes what rows are made of: solvers ask for the term, and for no effect by name.
PADDING = '''\
"""Padding: a regularised row gamma = c/dt^2 of a compliance c, without any key of surfaces."""

from .decision import Decision
from .effect import Effect, Fields, Hooks, kernel
from ..terms import RowTerms

COMPLIANCE = 1e-4  # [m/N]


def decide(facts):
    return Decision(bool(facts.pairs), "whatever touches is padded")


def make(spec):
    def pad(contact, pair, params):
        contact.gamma += COMPLIANCE / (params.dt * params.dt)

    return kernel(pad, spec)


EFFECT = Effect(
    name="padding",
    decide=decide,
    per="contact",
    row=RowTerms(compliant=True),
    fields=Fields(contact=[("gamma", "f8")]),
    hooks=Hooks(capture=make),
)
'''
PADDED = """\
question: With which impulse does a padded ball begin to rest, by each solver?
expected: With the share of its weight that its regularised row leaves.
scene:
  bodies:
    floor: {shape: {kind: plane}}
    ball: {shape: {kind: sphere, radius: 0.1}, mass: 1.0, position: [0, 0, 0.1]}
numerics: {preset: chapter, timestep: 1/240, sweeps: 1000}
duration: 1/240
sweep:
  solver:
    path: numerics.solver
    values: [projected_gauss_seidel, jacobi, accelerated_projected_gradient]
measure:
  fall: {kind: drift, after: 0.0}
expect:
  - {name: it hardly moves, measure: fall, at_most: 1.0}
"""
# Prints the impulses of all contacts of every cell of a run.
IMPULSES = """
import json, sys
from pathlib import Path
from lavendersim.trace import open_trace

cells = Path(sys.argv[1]).glob("*-*/cells/*.mcap")  # not `latest`
print(json.dumps([open_trace(path).contact["impulse_n"].tolist() for path in cells]))
"""
REST = """\
question: What does the floor carry?
expected: The weight less what the cushion carries.
scene:
  bodies:
    floor: {shape: {kind: plane}}
    ball:
      shape: {kind: sphere, radius: 0.1}
      mass: 1.0
      surface: {cushion: 4.0}
      position: [0, 0, 0.1]
numerics: chapter
duration: 0.1
measure:
  fall: {kind: drift, after: 0.0}
expect:
  - {name: it stays where it is, measure: fall, at_most: 1e-9}
"""
# Prints the columns of the contacts of a log, and what they mean.
READ = """
import json, sys
from pathlib import Path
from mcap.reader import make_reader
from lavendersim.trace import open_trace

(path,) = Path(sys.argv[1]).glob("*-*/cells/*.mcap")  # not `latest`
contact = open_trace(path).contact
with path.open("rb") as stream:
    channels = make_reader(stream).get_summary().channels.values()
(meanings,) = [channel.metadata for channel in channels if channel.topic == "/contact_columns"]
print(json.dumps({"pressing": contact["impulse_n"].tolist(), "meaning": meanings["cushion_impulse"],
                  "cushion": contact["cushion_impulse"].tolist()}))
"""
# Prints the plan's word on the wind, and the ball's velocity along x after each of 30 steps.
BLOW = """
import json, sys
from pathlib import Path
import lavendersim
from lavendersim.experiment import load_experiment
from lavendersim.scene.build import build
from lavendersim.scene.plan import plan_of

cell = next(iter(load_experiment(Path(sys.argv[1])).cells())).config
plan = plan_of(cell)
engine = build(cell, plan.spec).engine(plan.spec)
speeds, hashes = [], []
for _ in range(30):
    engine.advance(1)
    speeds.append(float(engine.velocities["vx"][1]))
    hashes.append(int(engine.take_rows().step["state_hash"][-1]))
decision = plan.decisions.get("wind")
print(json.dumps({"package": lavendersim.__file__, "decision": decision, "speeds": speeds,
                  "hashes": hashes, "columns": engine.bodies.dtype.names}))
"""


class Copy:
    """A copy of lavender that is run by processes of its own."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        without = shutil.ignore_patterns("*.pyc.*")  # bytecode that others are writing
        shutil.copytree(ROOT / "lavendersim", folder / "lavendersim", ignore=without)
        shutil.copytree(ROOT / "cli", folder / "lavender_cli", ignore=without)
        self.config = folder / "drop.yaml"
        self.config.write_text(DROP)

    def add(self, name: str, text: str, listed: bool = True) -> None:
        """Add the file of an effect and, where it is to be listed, its line."""
        (self.folder / f"lavendersim/engine/effects/{name}.py").write_text(text)
        if listed:
            path = self.folder / LIST
            text = path.read_text()
            line = '    "warm_start",\n'
            assert text.count(line) == 1
            path.write_text(text.replace(line, f'{line}    "{name}",\n'))

    def python(self, *arguments: Any, code: int = 0) -> str:
        """Return what a Python process prints; -P: this copy, not the working directory's."""
        done = subprocess.run(
            [sys.executable, "-P", *map(str, arguments)],
            env=os.environ | {"PYTHONPATH": str(self.folder), "NO_COLOR": "1"},
            capture_output=True,
            text=True,
            timeout=300,
            check=False,
        )
        assert done.returncode == code, done.stderr
        return done.stdout + done.stderr if code else done.stdout

    def blow(self) -> dict[str, Any]:
        found: dict[str, Any] = json.loads(self.python("-c", BLOW, self.config).splitlines()[-1])
        assert found["package"].startswith(str(self.folder))
        return found

    def lavender(self, *arguments: Any, code: int = 0) -> str:
        """Return what a command prints, with its complaints where it is to fail."""
        command = "import sys; from lavender_cli.main import main; sys.argv[0] = 'lavender'; main()"
        return self.python("-c", command, *arguments, code=code)

    def plan(self) -> str:
        return self.lavender("plan", self.config)


def test_an_effect_is_added_by_a_file_and_a_line(tmp_path: Path) -> None:
    copy = Copy(tmp_path)
    calm = copy.blow()
    copy.add("wind", WIND, listed=False)
    unlisted = copy.blow()
    assert unlisted == calm  # a file that nothing lists
    assert calm["decision"] is None
    assert set(calm["speeds"]) == {0.0}
    copy.add("wind", WIND)
    windy = copy.blow()
    assert windy["decision"][0] is True
    assert "wind" in windy["columns"]
    (line,) = [line for line in copy.plan().splitlines() if line.startswith("wind ")]
    assert line.split(maxsplit=2) == ["wind", "on", "ball stands in a wind of 3 m/s"]
    # v_k = u (1 - (1 - c dt/m)^k) with u = 3 m/s, c = 0.4 N s/m, m = 1 kg, dt = 1/240 s; each of
    # 30 steps rounds a handful of times, 2^-53 each, of numbers below 0.2.
    expected = [3.0 * (1.0 - (1.0 - 0.4 / 240.0) ** k) for k in range(1, 31)]
    assert windy["speeds"] == pytest.approx(expected, rel=0.0, abs=30 * 4 * 2.0**-53)


def test_an_effect_with_a_key_a_contact_term_and_a_column_is_a_file_and_a_line(
    tmp_path: Path,
) -> None:
    """The config accepts its key, the plan gives its reason, and a run logs its column."""
    copy = Copy(tmp_path)
    copy.config.write_text(REST)
    refused = copy.lavender("plan", copy.config, code=2)
    assert "drop.yaml:9:17: " in refused
    assert "cushion" in refused
    copy.add("cushion", CUSHION)
    (line,) = [line for line in copy.plan().splitlines() if line.startswith("cushion ")]
    assert line.split(maxsplit=2) == ["cushion", "on", "floor and ball: a cushion of 4 N"]
    copy.config.write_text(REST.replace("4.0}", "-4.0}"))
    refused = copy.lavender("plan", copy.config, code=2)
    assert "drop.yaml:9:26: " in refused
    assert "expected a number of 0 or more [N], found -4.0" in refused
    copy.config.write_text(REST)
    copy.lavender("run", copy.config, "--runs", tmp_path / "runs")
    log = json.loads(copy.python("-c", READ, tmp_path / "runs").splitlines()[-1])
    assert log["meaning"] == "of the air on B along the normal [N s]"
    steps = len(log["cushion"])
    assert steps == 24
    assert log["cushion"] == [4.0 / 240.0] * steps
    # m g dt less F dt, each of a few roundings.
    assert log["pressing"] == pytest.approx([(9.81 - 4.0) / 240.0] * steps, rel=1e-13)


def test_an_effect_that_softens_rows_is_a_file_and_a_line(tmp_path: Path) -> None:
    """Whatever solver there is takes the term from the declaration."""
    copy = Copy(tmp_path)
    copy.config.write_text(PADDED)
    copy.add("padding", PADDING)
    copy.lavender("run", copy.config, "--runs", tmp_path / "runs")
    pushed = json.loads(copy.python("-c", IMPULSES, tmp_path / "runs").splitlines()[-1])
    # Of a ball at rest: m v = lambda - m g dt and v + gamma lambda = 0, with gamma = c/dt^2.
    mass, dt, gamma = 1.0, 1.0 / 240.0, 1e-4 * 240.0**2
    expected = mass * 9.81 * dt / (1.0 + mass * gamma)
    # A thousand sweeps of one row, whose error shrinks to round-off of 6 m/s / 240.
    assert pushed == [[pytest.approx(expected, rel=0.0, abs=1e-12)]] * 3
