import importlib.util
from pathlib import Path

import pytest

HERE = Path(__file__).parent


@pytest.fixture(scope="session")
def brute_force():
    """The independent evaluator of the cutting tests."""
    spec = importlib.util.spec_from_file_location("brute_force", HERE.parent / "cutting" / "brute_force.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
