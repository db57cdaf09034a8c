import importlib.util
import sys
from pathlib import Path

import pytest


@pytest.fixture(scope="session")
def parts():
    """The module of analytic meshes of the inspection's tests."""
    path = Path(__file__).parents[1] / "inspection" / "analytic_parts.py"
    spec = importlib.util.spec_from_file_location("analytic_parts", path)
    module = importlib.util.module_from_spec(spec)
    sys.modules["analytic_parts"] = module
    spec.loader.exec_module(module)
    return module
