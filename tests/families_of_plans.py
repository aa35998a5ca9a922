"""Plans that scenes of the suite share, as the cells of one sweep do.

A kernel takes five to twenty seconds to compile, and scenes differ in little. Each family here is
planned as the cells of one sweep are (`runner.plans`): one plan, the union, for all that make the
same choices between laws. A scene whose plan is a part of a family's has that one. What it has
beside what the scene requires is idle there and changes no bit (tests/composition: each effect
alone, and random subsets).

Some effects do change something where they are added, and never are (`NEVER_ADDED`): with
`impact_order` an impact of one pair alone has its rows in its own step and none in the next one;
with `rotation` places of frictionless balls that slide differ in their last bit; with
`residual_log` sweeps are counted that change nothing.

Runs of tests/physics ask for a family's plan (`spec_of_family`). The suite runs shipped configs so,
but for the chapter's, and the files of `SHARING` (`ScenesSharePlans`, which tests/conftest.py
registers); `pytest configs`, `LAVENDER_TEST_EVERYTHING=1 pytest`, and everybody else, runs each by
its own plan.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from lavendersim.engine.collide import SHAPE_PAIRS
from lavendersim.engine.spec import Spec
from lavendersim.experiment import load_experiment, load_experiment_text
from lavendersim.experiment.cell import Cell
from lavendersim.scene.plan import CHOICES, Plan
from tests import scenes_of_families as scenes

NEVER_ADDED = {
    *("error_control", "impact_order", "packed_sweeps", "residual_log", "rotation"),
    *("anderson_acceleration", "supernodes"),
}
BY_EFFECTS = CHOICES.index("sleeping")  # a choice that says no more than that the effect is there
ROOT = Path(__file__).parents[1]
CONFIGS = ROOT / "configs"
CHAPTER = CONFIGS / "chapter"
# Files of tests, and folders of them, whose runs in the process of the test share plans, too.
SHARING = (
    *("tests/gallery", "tests/cli/test_new_command.py", "tests/unit/laws/test_judging_of_laws.py"),
    *("tests/unit/runner/test_log_size.py", "tests/unit/trace/test_contact_columns_derived.py"),
    *("tests/unit/trace/test_sphere_contacts.py",),
)
BALLS = ("sphere_plane", "sphere_sphere")
BALLS_AND_BOXES = (*BALLS, "box_box", "box_plane", "sphere_box")


class Family(NamedTuple):
    """Scenes that are planned together: shipped configs by their names, and texts of configs.

    Shape pairs and effects are beside those that the scenes require.
    """

    configs: tuple[str, ...] = ()
    texts: tuple[str, ...] = ()
    shape_pairs: tuple[str, ...] = ()
    effects: tuple[str, ...] = ()

    def cells(self) -> Iterator[Cell]:
        """Yield the cells of all scenes."""
        for name in self.configs:
            yield from load_experiment(CONFIGS / f"{name}.yaml", True).cells()
        for text in self.texts:
            yield from load_experiment_text(text, "family.yaml").cells()


# The first that has what a scene requires is taken: lean ones, which many scenes have, come first.
FAMILIES = (
    Family(("scenes/drop",)),
    Family(("scenes/free_rotation",)),
    Family(("time/ball_on_ball", "scenes/bullet", "time/corner_of_three_walls")),
    Family(("chapter/timestep_and_compliance", "paw_check/two_movable_masses")),
    Family(("scenes/pile", "scenes/pyramid", "hard/crowd/pile_of_2000")),
    Family(
        (
            *("time/turntable", "time/ball_on_turntable", "time/slope", "time/disc_that_nods"),
            *("time/heavy_top", "time/flush_seams", "time/box_between_walls", "scenes/rod_end"),
            # With controls by older laws, which share plans, too: at the surface, captured.
            *("time/rolling_over_seams", "time/bodies_that_meet_within_a_step"),
            "time/striking_across_a_gap",
            *("scenes/rest", "scenes/frictional_rod", "language/rolling_bodies"),
            *("language/changes_during_a_run", "hard/removed_load/top_ball_deleted"),
            *("hard/friction/wedge_jam", "hard/friction/conveyor"),
            *("hard/restitution/cube_on_slab",),
        )
    ),
    Family(("hard/tall/jenga", "effects/table")),
    # Whatever surfaces, forces and motions may have, where nothing gives way and nothing is tied.
    Family(
        (
            *("effects/anisotropic_friction", "effects/contact_patch", "effects/static_friction"),
            *("effects/grain_on_a_slope", "effects/tangential_restitution"),
            *("effects/prescribed_motion", "effects/varying_force", "language/events_on_states"),
            *("language/passages", "hard/structure/arch_of_seventeen_voussoirs"),
            *("trackers/pinched_between_pads", "trackers/three_balls"),
            *(
                "trackers/pressed_against_a_wall",
                "scenes/rocking_ellipsoid",
                "scenes/rolling_cone",
                "scenes/bowl",
                "scenes/drum",
                "scenes/triangles",
                "scenes/height_field",
            ),
        ),
        (scenes.TURNING,),
        (
            *BALLS_AND_BOXES,
            "capsule_plane",
            "cylinder_box",
            "cylinder_cylinder",
            "cylinder_plane",
            "cone_plane",
            "ellipsoid_plane",
            *("sphere_bowl", "box_bowl", "sphere_drum", "cylinder_drum"),
            *("sphere_mesh", "box_mesh", "cylinder_mesh"),
            "hull_plane",
            "sphere_cylinder",
        ),
    ),
    # What gives way, and what ropes and springs tie; what joints hold, beside springs.
    Family(texts=(scenes.SPRINGY, scenes.LINKED), shape_pairs=BALLS_AND_BOXES),
    Family(("effects/joint", "effects/motor"), (scenes.JOINTED,), BALLS_AND_BOXES, ("spring",)),
    Family(texts=(scenes.JOINTED_APART,)),
    Family(("effects/rope", "effects/spring", "hard/contact/soft_to_stiff"), effects=("drag",)),
    Family(("effects/falling_restitution", "effects/cohesion")),
    Family(("effects/hertz_contact", "effects/tangential_compliance"), shape_pairs=BALLS),
    Family(("scenes/oblique_impact", "hard/friction/rolling_resistance")),
    Family(("cost/residual_by_sweep", "hard/timestep/changes_during_the_run")),
    # The engine with everything, which the fuzz compiles.
    Family(
        ("hard/found/cohesion_of_what_turns", "hard/found/springs_beside_what_gives_way"),
        shape_pairs=tuple(
            name
            for name, pair in SHAPE_PAIRS.items()
            if {"ellipsoid", "cone"} & {*pair.shapes} or pair.own_normals
        ),
        effects=(
            *("anisotropic_friction", "contact_patch", "joint", "joint_stop", "motor"),
            *("tangential_compliance", "tangential_restitution", "velocity_log"),
        ),
    ),
    Family(
        ("time/accuracy_of_energy", "time/accuracy_of_rolling"),
        (scenes.ACCURATE,),
        (*BALLS_AND_BOXES, "cylinder_box", "cylinder_plane", "sphere_cylinder", "sphere_drum"),
        ("sleeping",),
    ),
    Family(texts=(scenes.BALLS,), shape_pairs=BALLS, effects=("broad_phase",)),
    Family(("time/cradle_with_gaps", "time/near_miss", "time/gas_of_hard_spheres")),
    Family(texts=(scenes.CHAPTER_BALLS,), shape_pairs=BALLS, effects=("broad_phase", "sleeping")),
    Family(
        ("hard/maps/compliance_and_gain", "paw_check/off_centre_box"),
        (scenes.CHAPTER_TURNING,),
        BALLS_AND_BOXES,
        ("frictionless_contact",),
    ),
)


class Shared(NamedTuple):
    """A plan of a family: what is compiled, and the laws that it chooses."""

    spec: Spec
    choices: tuple[Any, ...]

    def serves(self, plan: Plan) -> bool:
        """Whether a plan chooses the same laws, and all else that this one has is idle in it."""
        has, required = {*self.spec.effects}, {*plan.spec.effects}
        return (
            _laws(plan.choices) == _laws(self.choices)
            and plan.spec[2:] == self.spec[2:]
            and {*plan.spec.shape_pairs} <= {*self.spec.shape_pairs}
            and required <= has
            and not NEVER_ADDED & (has - required)
        )


def _laws(choices: tuple[Any, ...]) -> tuple[Any, ...]:
    return choices[:BY_EFFECTS] + choices[BY_EFFECTS + 1 :]


def spec_of_family(plan: Plan) -> Spec:
    """Return what is compiled for a plan: a family's that has all of it, or its own."""
    for family in FAMILIES:
        for shared in shared_by(family):
            if shared.serves(plan):
                return shared.spec
    return plan.spec


@cache
def shared_by(family: Family) -> tuple[Shared, ...]:
    """Return the plans of a family, one for each choice of laws."""
    from lavendersim.runner.plans import distinct, shared_plans

    found = []
    for plan in distinct(shared_plans(family.cells())):
        pairs = tuple(sorted({*plan.spec.shape_pairs, *family.shape_pairs}))
        spec = plan.spec.including(*family.effects)._replace(shape_pairs=pairs)
        found.append(Shared(spec, plan.choices))
    return tuple(found)


def with_specs_of_families(plans: Iterable[Plan]) -> list[Plan]:
    """Return plans of cells with what is compiled for them; one object stays one object."""
    known: dict[int, Plan] = {}
    found = []
    for plan in plans:
        if id(plan) not in known:
            known[id(plan)] = plan._replace(spec=spec_of_family(plan))
        found.append(known[id(plan)])
    return found


class ScenesSharePlans:
    """A plugin: shipped configs, and files of `SHARING`, share plans as parts of the suite."""

    sharing = (CONFIGS, *(ROOT / place for place in SHARING))

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Any:
        """Let the plan of a scene that is run in this process be a family's."""
        if item.path.is_relative_to(CHAPTER) or not any(
            map(item.path.is_relative_to, self.sharing)
        ):
            return (yield)
        from lavendersim.runner import planning, plans

        def joined_by_families(parts: Sequence[plans.Decided]) -> list[Plan]:
            return with_specs_of_families(plans.joined(parts))

        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(planning, "joined", joined_by_families)
            return (yield)
