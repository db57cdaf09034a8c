"""Whatever comes in ends in a finished program or in an alarm with its place: 2 000 programs, the same every
time. `python tests/fuzz/fuzzing.py COUNT` runs more."""

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import pytest


def _load() -> ModuleType:
    path = Path(__file__).with_name("fuzzing.py")
    spec = importlib.util.spec_from_file_location("fuzzing", path)
    assert spec
    assert spec.loader
    module = importlib.util.module_from_spec(spec)
    sys.modules["fuzzing"] = module
    spec.loader.exec_module(module)
    return module


FUZZING = _load()
PARTS = 8
PROGRAMS = 2000


@pytest.mark.parametrize("part", range(PARTS))
def test_random_programs(part: int, monkeypatch: pytest.MonkeyPatch) -> None:
    for module, name, value in FUZZING.LOW_LIMITS:
        monkeypatch.setattr(module, name, value)
    outcomes = {FUZZING.run_one(seed) for seed in range(part, PROGRAMS, PARTS)}
    assert len(outcomes) > 20  # they end in many ways
    assert "finished" in outcomes
