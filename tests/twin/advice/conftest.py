"""Fixtures: a job of a scene, changed here and there, and the advice on it."""

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from controller.dry_run import dry_run
from controller.language.source import load_program
from controller.tables.machine_data import machine_data
from twin.advice.advice import Advice
from twin.advice.adviser import Adviser
from twin.advice.scene import scene_of
from twin.job import read_job
from twin.presets import cutters_of, settings_of

SCENES = Path(__file__).parents[3] / "scenes"


def advice_on(folder: Path, *, alarms: int = 0) -> tuple[Advice, ...]:
    job = read_job(folder)
    cutters = cutters_of(job)
    settings = settings_of(job, cutters)
    adviser = Adviser(scene_of(job, cutters, machine_data(settings.parameters)))
    found = dry_run(
        load_program(job.program),
        settings.parameters,
        settings.offsets,
        settings.signals,
        observe=adviser.see,
    )
    assert len(found.alarms) == alarms, found.alarms
    return adviser.close()


@pytest.fixture
def advise(tmp_path: Path) -> Callable[..., list[Advice]]:
    """Advice on a scene with texts of job.toml and program.nc replaced, each of which must be there."""

    def _advise(
        scene: str,
        *,
        job: dict[str, str] | None = None,
        program: dict[str, str] | None = None,
        alarms: int = 0,
    ) -> list[Advice]:
        folder = tmp_path / scene
        shutil.copytree(SCENES / scene, folder, dirs_exist_ok=True)
        for name, changes in (("job.toml", job or {}), ("program.nc", program or {})):
            text = (folder / name).read_text(encoding="utf-8")
            for old, new in changes.items():
                assert old in text
                text = text.replace(old, new)
            (folder / name).write_text(text, encoding="utf-8")
        return list(advice_on(folder, alarms=alarms))

    return _advise


@pytest.fixture
def scenes() -> Path:
    return SCENES


@pytest.fixture
def advice_of() -> Callable[[Path], tuple[Advice, ...]]:
    return advice_on
