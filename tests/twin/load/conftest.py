import importlib
import sys
from pathlib import Path

import pytest

# the helper modules beside this file, and the closed-form motions of the cutting tests
sys.path.insert(0, str(Path(__file__).parent))
sys.path.insert(0, str(Path(__file__).parents[1] / "cutting"))


@pytest.fixture(scope="session")
def synthetic():
    """Closed-form motions."""
    return importlib.import_module("synthetic_motion")
