"""The sums that a kernel takes while a cell runs are those that numpy takes of its log.

Two algorithms, one over the engine's rows in one pass and one column by column over the log's
table: equal to the last bit.
"""

from __future__ import annotations

import numpy as np
import pytest

from lavendersim.measures.contact_sums import ContactSums, summed
from lavendersim.measures.sections import Section
from lavendersim.runner.contact_sums_kernel import RunningSums
from tests.unit.measures.random_contacts import FORMS, section


def by_kernel(part: Section) -> ContactSums:
    sums = RunningSums(part.config, list(part.bodies), part.clock)
    return sums(part.step, part.contact)


@pytest.mark.parametrize("cone", ["disc", "pyramid"])
@pytest.mark.parametrize("wrong", [0.0, 0.01, 0.3])
@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("integrator", ["semi_implicit_euler", "midpoint_contact"])
def test_kernel_and_log_give_the_same_bits(
    integrator: str, form: str, wrong: float, cone: str
) -> None:
    part = section(FORMS[form], cone, wrong, integrator=integrator)
    with np.errstate(all="ignore"):
        of_log = summed(part)
    for name, numbers in zip(ContactSums._fields, by_kernel(part), strict=True):
        np.testing.assert_array_equal(numbers, getattr(of_log, name), err_msg=name)
