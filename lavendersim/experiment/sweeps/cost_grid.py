"""The grid of settings of a `cost` section, as one experiment that sweeps them.

A setting is a preset and five of the numerics: timestep, solver, sweeps, tolerance, warm start; and
an accuracy, where steps are made in substeps. It becomes a product of the sweep, with the
experiment's own axes inside it:

    - {preset: .., timestep: .., solver: .., sweeps: .., tolerance: .., warm_start: .., <own axes>}
    - {numerics: chapter, <own axes>}                                       the chapter's setting

so that a grid is run, logged, measured and kept like any other sweep. Other engines have products
of their own (`engine_grid`).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import product
from typing import Any, Final, Literal, NamedTuple, get_args

from lavendersim.cell.choices import Solver
from lavendersim.experiment.experiment import Experiment
from lavendersim.experiment.load import load_experiment_text
from lavendersim.experiment.models.cost import KNOBS, CostSpec
from lavendersim.experiment.models.steps import is_of_order_two
from lavendersim.experiment.resolve.presets import DEFAULT, PRESETS, specified_numerics
from lavendersim.experiment.sweeps.engine_grid import Own, paths_of, section_of, variants_of
from lavendersim.experiment.text.yaml_text import as_yaml
from lavendersim.peers.catalogue import LAVENDER

CHAPTER: Final = "chapter"  # name of a preset; its axis is `numerics`
# They sweep until a residual is reached, however long that takes; all others take their sweeps.
BY_TOLERANCE: Final = ("adaptive",)
FINER: Final = 8  # the truth's timestep is the grid's finest over this
TRUTH_TOLERANCE: Final = 1e-12  # [m/s] a thousandth of the default's
TRUTH_SWEEPS: Final = 10_000
# What the experiment that sweeps the grid does without: they speak of the own sweep, not of it.
_LEFT_OUT: Final = ("expect", "figure", "overhead", "cost", "engine")
# What a setting of another engine has in the place of lavender's numerics: nothing.
_NO_NUMERICS: Final[dict[str, Any]] = {
    "solver": "",
    "sweeps": 0,
    "tolerance": None,
    "warm_start": True,
}

Role = Literal["grid", "specified", "chapter", "truth"]


class Setting(NamedTuple):
    """One point of the grid."""

    role: Role  # of the grid; the config's own; the chapter's; what others are compared with
    preset: str  # of what it leaves alone
    timestep: Fraction  # [s]
    solver: str
    sweeps: int  # at most
    tolerance: float | None  # [m/s]
    warm_start: bool
    accuracy: float | None = None  # None: every step is one timestep long
    engine: str = LAVENDER  # or a variant of another; of numerics it has the timestep alone
    own: Own = ()  # settings of that engine

    @property
    def knobs(self) -> dict[str, Any]:
        """The numerics it sets."""
        if self.engine != LAVENDER:
            return {"timestep": self.timestep}
        asked = {} if self.accuracy is None else {"accuracy": self.accuracy}
        return {name: getattr(self, name) for name in KNOBS} | asked

    @property
    def curve(self) -> tuple[Any, ...]:
        """What settings share that differ in their timestep alone."""
        # whatever else the config specifies, the chapter's has the preset's numbers
        own = self.role == "chapter"
        effort = self.sweeps, self.tolerance, self.warm_start, self.accuracy
        return (own, self.preset, self.solver, *effort, self.engine, self.own)

    @property
    def coordinates(self) -> dict[str, Any]:
        """Its place in the sweep, by axis."""
        if self.role == "chapter":
            return {"numerics": CHAPTER}
        return {"preset": self.preset, **self.knobs}


def settings_of(experiment: Experiment, engines: Sequence[str] = (LAVENDER,)) -> list[Setting]:
    """Return the settings: the config's own, the grid, the chapter's; of other engines those that
    they declare; the truth's if any. Of lavender's only where it is among the engines.
    """
    spec = experiment.config.cost
    assert spec is not None
    preset, _ = _specified(experiment)
    settings = _of_lavender(experiment, spec) if LAVENDER in engines else []
    settings += [
        Setting("grid", preset, timestep, **_NO_NUMERICS, engine=variant, own=own)
        for engine in engines
        if engine != LAVENDER
        for variant, own, timestep in variants_of(engine, spec.timesteps)
    ]
    if spec.error.truth == "finest":
        finest = min(spec.timesteps) / FINER
        truth = (finest, "adaptive", TRUTH_SWEEPS, TRUTH_TOLERANCE, True)
        settings.append(Setting("truth", preset, *truth))
    return list(dict.fromkeys(settings))


def _of_lavender(experiment: Experiment, spec: CostSpec) -> list[Setting]:
    preset, others = _specified(experiment)
    numerics = experiment.cells()[0].config.numerics
    own = {name: getattr(numerics, name) for name in (*KNOBS, "accuracy")}
    specified = Setting("specified", preset, **own)
    values = PRESETS[CHAPTER]
    chapter = Setting("chapter", CHAPTER, **{name: getattr(values, name) for name in KNOBS})
    alone = {specified[1:]} | ({chapter[1:]} if not others else set())
    grid = [each for each in dict.fromkeys(_grid(spec, specified, others)) if each[1:] not in alone]
    settings = [specified, *grid]
    if others or specified[1:] != chapter[1:]:
        settings.append(chapter)
    return settings


def _grid(spec: CostSpec, specified: Setting, others: Mapping[str, Any]) -> Iterator[Setting]:
    presets = spec.presets or (specified.preset,)
    solvers = get_args(Solver) if spec.solvers == "all" else spec.solvers
    most = DEFAULT.sweeps if specified.tolerance is None else specified.sweeps
    outer = product(presets, solvers, spec.warm_start, spec.timesteps)
    for preset, solver, warm, timestep in outer:
        if solver in BY_TOLERANCE:
            for tolerance in spec.tolerances:
                yield Setting("grid", preset, timestep, solver, most, tolerance, warm)
        else:
            for sweeps in spec.sweeps:
                yield Setting("grid", preset, timestep, solver, sweeps, None, warm)
    warm, tolerance = any(spec.warm_start), min(spec.tolerances)
    for preset, accuracy in product(presets, spec.accuracies):
        if is_of_order_two({**dict(PRESETS[preset]), **others}):
            longest = max(spec.timesteps)
            yield Setting("grid", preset, longest, "adaptive", most, tolerance, warm, accuracy)


def _specified(experiment: Experiment) -> tuple[str, dict[str, Any]]:
    """Return the preset of a config, and what else its numerics specify, beside the knobs."""
    preset, values = specified_numerics(experiment.tree)
    return preset, {
        key: node.data for key, node in values.items() if key not in (*KNOBS, "accuracy")
    }


def over_the_grid(experiment: Experiment, settings: list[Setting]) -> Experiment:
    """Return the experiment with every setting as a product of its sweep."""
    data = {key: value for key, value in experiment.tree.data.items() if key not in _LEFT_OUT}
    data.setdefault("numerics", "default")
    if isinstance(data["numerics"], Mapping):  # an axis gives it back to the config's own setting
        data["numerics"] = {k: v for k, v in data["numerics"].items() if k != "accuracy"}
    own = data.pop("sweep", None) or {}
    products = own if isinstance(own, tuple) else (own,)
    data["sweep"] = tuple({**_axes(setting), **axes} for setting in settings for axes in products)
    head = f"# {experiment.name}: the settings of its section `cost`, as a sweep.\n"
    for override in experiment.options.overrides:
        head += f"# with --{' '.join(override.split())}\n"
    swept = load_experiment_text(head + as_yaml(data), str(experiment.path))
    return replace(swept, name=experiment.name)


def _axes(setting: Setting) -> dict[str, Any]:
    places = {
        name: (name if name == "numerics" else f"numerics.{name}", value)
        for name, value in setting.coordinates.items()
    } | paths_of(setting.engine, setting.own)
    return {name: {"path": path, "values": (value,)} for name, (path, value) in places.items()}


def fragment_of(experiment: Experiment, setting: Setting) -> str:
    """Return the keys that give this setting in this experiment, as YAML: `numerics` of lavender's,
    of another engine the engine, its settings and the timestep.
    """
    if setting.engine != LAVENDER:
        timestep = {"numerics": {"timestep": setting.timestep}}
        return as_yaml(section_of(setting.engine, setting.own) | timestep)
    if setting.role == "chapter":
        return f"numerics: {CHAPTER}\n"
    defaults = dict(PRESETS[setting.preset])
    chosen: dict[str, Any] = {} if setting.preset == "default" else {"preset": setting.preset}
    chosen |= _specified(experiment)[1]
    chosen |= {key: value for key, value in setting.knobs.items() if value != defaults[key]}
    whole = list(chosen) in ([], ["preset"])
    return as_yaml({"numerics": setting.preset if whole else chosen})
