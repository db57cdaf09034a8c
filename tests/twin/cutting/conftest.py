import importlib
import sys
from pathlib import Path

import pytest

# the helper modules beside this file, for tests and for each other
sys.path.insert(0, str(Path(__file__).parent))


@pytest.fixture(scope="session")
def brute_force():
    """The independent evaluator."""
    return importlib.import_module("brute_force")


@pytest.fixture(scope="session")
def synthetic():
    """Closed-form motions."""
    return importlib.import_module("synthetic_motion")
