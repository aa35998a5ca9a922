"""An effect that accelerates bodies or captures contacts is its file and its name in one list.

Nothing else in the engine or the scene names it, but for what is listed here with its reason. To
show that this is enough, a wind is added to a copy of lavender: one file, one line.
"""

from __future__ import annotations

import ast
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from sources import ROOT

from lavendersim.engine.effects import EFFECTS, Effect
from tests.drop_config import DROP

LIST = "lavendersim/engine/effects/__init__.py"
CHAINED = [effect for effect in EFFECTS if effect.hooks.accelerate or effect.hooks.capture]
FACT = "a property of the scene, which predicates may ask for, has the same name"
ROW = "a soft row is a term in what every solver computes"
TIME = "what gives way takes time: no impact of an instant"
SPRING = "it has a penetration of its own, and no impact"
LAW = "a row ahead of touching must be looked for, and its body's flight be kept"
# Where else a name stands, as an identifier or a string, and why it must.
ELSEWHERE = {
    "gravity": {
        "engine/effects/decision.py": FACT,
        "scene/facts.py": FACT,
        "scene/laws.py": FACT,
        "scene/build.py": "its vector is a parameter of the run, with the other coefficients",
        "engine/effects/fast_bodies.py": "how fast bodies may fall",
        "scene/expected_contacts.py": "how soon bodies have landed",
    },
    "external_force": {
        "engine/effects/sleeping.py": "who is pushed does not sleep",
        "scene/events.py": "forces begin and end during the run",
    },
    "compliance": {
        "engine/effects/pairwise_impacts.py": TIME,
        "engine/effects/fast_bodies.py": "springs give energy back",
        "engine/effects/impact_order.py": TIME,
        "engine/foreseen_impacts.py": TIME,
        "engine/impact_rows.py": TIME,
        "engine/effects/contact_spring.py": "is another law of it",
        "engine/contact.py": ROW,
        "engine/assemble.py": ROW,
        "engine/error_estimate.py": SPRING,
        "engine/residual.py": ROW,
        "engine/solvers/row_update.py": ROW,
        "engine/solvers/newton/response.py": ROW,
        "engine/solvers/newton/faces.py": ROW,
        "engine/solvers/newton/least_norm.py": ROW,
        "engine/solvers/packed/packing.py": ROW,
        "engine/solvers/packed/sweep.py": ROW,
        "engine/solvers/jacobi.py": ROW,
        "engine/solvers/step_bound.py": ROW,
        "engine/solvers/accelerated_projected_gradient.py": ROW,
    },
    "contact_spring": {
        "engine/effects/pairwise_impacts.py": SPRING,
        "engine/effects/impact_order.py": SPRING,
        "engine/foreseen_impacts.py": SPRING,
        "engine/impact_rows.py": SPRING,
        "engine/effects/impact_time.py": SPRING,
        "engine/effects/projection.py": SPRING,
        "engine/midpoint_rows.py": SPRING,
    },
    "restitution": {
        "engine/effects/capture_in_sweeps.py": "makes a mistake with it",
        "engine/effects/fast_bodies.py": "captured, it gives energy",
        "engine/effects/impact_energy.py": "takes the place of its law",
        "engine/foreseen_impacts.py": "a rebound tells an impact from a lasting contact",
    },
    "speculative": {
        "engine/effects/decision.py": FACT,
        "scene/facts.py": FACT,
        "scene/plan.py": "numerics choose this law: cells that differ in it share no engine",
        "engine/effects/fast_bodies.py": "finds where to look ahead",
        "engine/effects/contact_log.py": "rows ahead that never push are not logged",
        "engine/effects/sleeping.py": LAW,
        "engine/integrate.py": LAW,
        "engine/collide/narrow_phase.py": LAW,
        "engine/collide/pairs/box_box.py": LAW,
    },
}
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
numerics: {timestep: 1/240}
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


def names(file: Path) -> set[str]:
    """Return the identifiers and strings of a source file; prose and docstrings are none."""
    found = set()
    for node in ast.walk(ast.parse(file.read_text())):
        for field in ("id", "attr", "arg", "name", "module"):
            found.add(getattr(node, field, None))
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            found.add(node.value)
    return {name for name in found if isinstance(name, str)}


@pytest.mark.parametrize("effect", CHAINED, ids=lambda effect: effect.name)
def test_nothing_else_names_an_effect(effect: Effect) -> None:
    own = {LIST, f"lavendersim/engine/effects/{effect.name}.py"}
    files = [
        path for room in ("engine", "scene") for path in (ROOT / "lavendersim" / room).rglob("*.py")
    ]
    naming = {
        path.relative_to(ROOT / "lavendersim").as_posix()
        for path in files
        if path.relative_to(ROOT).as_posix() not in own and effect.name in names(path)
    }
    assert naming == set(ELSEWHERE.get(effect.name, ()))


class Copy:
    """A copy of lavender that is run by processes of its own."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        without = shutil.ignore_patterns("__pycache__")
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
