"""Modules that no unit test is named after: declarations with the reason, and those still without.

`test_unit_tests_mirror_the_source.py` reads both. A module that gets a test leaves its list.
"""

from __future__ import annotations

# No function: what is wrong in them is seen where a config, a log or an engine is made of them.
DECLARATIONS = {
    "cell/body.py": "fields of a resolved config",
    "cell/choices.py": "names of choices",
    "cell/numerics.py": "fields of a resolved config",
    "cell/shapes/compound.py": "fields of a resolved config",
    "cell/shapes/plane.py": "fields of a resolved config",
    "engine/solvers/catalogue.py": "a list of declarations",
    "figures/specs/base.py": "fields of a panel's config",
    "figures/specs/catalogue.py": "a union of models",
    "figures/specs/free_rotation.py": "fields of a panel's config",
    "figures/specs/heat_map.py": "fields of a panel's config",
    "figures/specs/measure_against_axis.py": "fields of a panel's config",
    "figures/specs/measure_by_name.py": "fields of a panel's config",
    "figures/specs/row_against_index.py": "fields of a panel's config",
    "figures/specs/stability_map.py": "fields of a panel's config",
    "measures/specs/catalogue.py": "a union of models",
    "measures/specs/convergence.py": "fields of a measure's config",
    "measures/specs/energy.py": "fields of a measure's config",
    "measures/specs/impact.py": "fields of a measure's config",
    "measures/specs/motion.py": "fields of a measure's config",
    "measures/specs/optimality.py": "fields of a measure's config",
    "measures/specs/overlap.py": "fields of a measure's config",
    "measures/specs/spinning.py": "fields of a measure's config",
    "measures/specs/steady.py": "fields of a measure's config",
}

# Folder: modules, without `.py`. A debt, to be made shorter: nothing is added here.
WITHOUT_A_TEST = {
    "comparison": """
        compare
    """,
    "engine": """
        difference_kernel engine error_estimate flush_contacts foreseen_impacts impact_location
        integrate kernel_parts midpoint_geometry midpoint_passes midpoint_rows part_compiler
        respond spring_midpoint step_doubling
    """,
    "engine/collide": """
        narrow_phase
    """,
    "engine/effects": """
        impact_order
    """,
    "experiment/checks": """
        messages reading
    """,
    "experiment": """
        experiment own_measures
    """,
    "experiment/models": """
        always arrangements axis bodies claims cost experiment overhead record
        recorded scene shapes steps study
    """,
    "experiment/resolve": """
        cell shape
    """,
    "experiment/sweeps": """
        cost_grid
    """,
    "experiment/text": """
        parse
    """,
    "figures": """
        ideal report report_matrix thumbnail
    """,
    "figures/panels": """
        free_rotation heat_map measure_against_axis measure_by_name row_against_index
        stability_map time_series trajectory
    """,
    "figures/specs": """
        time_series trajectory
    """,
    "measures": """
        always balance cell_judgements columns controls interfaces step_checks
        sweep_judgements
    """,
    "measures/kinds": """
        arithmetic convergence energy own spinning
    """,
    "measures/specs": """
        always arithmetic base expectation kinematics laws own selection states
    """,
    "problems": """
        interior_point newton_rounds search
    """,
    "replay": """
        blueprint removal viewer
    """,
    "runner": """
        bounds cell compile_times contact_sums_kernel cost cost_errors dask_cluster
        experiment_run export judge_again listing log_tables merge overhead_pairs remote
        result_tables results solver_matrix step_passes_kernel timed_engine verification
    """,
    "scene": """
        build drive_tables
    """,
    "trace": """
        contact_rows container decode descriptors forms groups index opening
        reader rebuild scan streams walk written_trace
    """,
}
