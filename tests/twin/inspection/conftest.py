import importlib.util
import sys
from pathlib import Path

import pytest

from twin.inspection.nominal import GearNominal


@pytest.fixture(scope="session")
def parts():
    """The module of analytic meshes beside this file."""
    spec = importlib.util.spec_from_file_location(
        "analytic_parts", Path(__file__).with_name("analytic_parts.py")
    )
    module = importlib.util.module_from_spec(spec)
    sys.modules["analytic_parts"] = module
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def named():
    """Nominals by the words of the generator."""

    def make(teeth=20, module=2.0, helix_deg=0.0, shift=0.0, accuracy_class=None, **more):
        return GearNominal(
            number_of_teeth=teeth,
            normal_module_mm=module,
            helix_angle_deg=helix_deg,
            profile_shift=shift,
            accuracy_class=accuracy_class,
            **more,
        )

    return make
