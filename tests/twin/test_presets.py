"""Presets of a job: X is the diameter at the tool's tip, whichever tool is in the spindle."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from controller.cnc import Controller
from controller.language.source import parse_program
from twin.job import read_job
from twin.machine import IdealMachine
from twin.presets import cutters_of, settings_of
from twin.session import record
from twin.setup import make_ready

SCENE = Path(__file__).parents[2] / "scenes" / "spur_m2_z20"


def test_x_is_the_diameter_at_the_tip_of_either_tool(tmp_path):
    """Rulings, section 0: X35. puts the outside circle of the hob on diameter 35 of the work."""
    shutil.copytree(SCENE, tmp_path / "job")
    path = tmp_path / "job" / "job.toml"
    text = path.read_text(encoding="utf-8")
    head, rest = text.split("[tool]\n")
    tool, tail = rest.split("[program]")
    second = tool.replace("70.0", "60.0")
    path.write_text(f"{head}[tools.1]\n{tool}\n[tools.2]\n{second}\n[program]{tail}", encoding="utf-8")
    job = read_job(path)
    cutters = cutters_of(job)
    ready, settings = make_ready(job, cutters), settings_of(job, cutters)
    program = parse_program("O1\nT0101\nG00 X35.\nG04 X0.1\nT0202\nG00 X35.\nG04 X0.1\nM30\n")
    controller = Controller(program, parameters=settings.parameters, offsets=settings.offsets)
    session = record(controller, IdealMachine(4), ready)
    recording = session.recording
    distance = np.hypot(recording.tool_centre_mm[:, 0], recording.tool_centre_mm[:, 1])
    for number, radius in ((1, 35.0), (2, 30.0)):
        last = np.flatnonzero(recording.tool == number)[-1]
        assert distance[last] - radius == pytest.approx(17.5, abs=1e-9)
