"""The lag of the follow type on the cut part: one gear, its front half at S150 and its back half at S600.

geometry.md, section 5: the flanks behind the change of speed are turned by (1 - k_ff) Δw_C / Kv_C.
"""

from pathlib import Path

import numpy as np
import pytest
import trimesh

from controller.cnc import Controller
from controller.language.source import parse_program
from twin.cutting.cut import cut
from twin.job import read_job
from twin.machine import MujocoMachine
from twin.presets import cutters_of, settings_of
from twin.session import record
from twin.setup import make_ready

JOB = """
[machine.parameters]
"201#2" = 1
"201#7" = 1
[machine.drives.work_spindle]
velocity_feedforward = 0.9
position_gain = 80.0
[work]
diameter_mm = 14.0
length_mm = 8.0
bore_mm = 6.0
[tool]
kind = "hob"
normal_module_mm = 1.0
outside_diameter_mm = 40.0
gashes = 6
[program]
file = "program.nc"
[nominal]
kind = "gear"
number_of_teeth = 12
normal_module_mm = 1.0
"""
PROGRAM = """O1
G00 X20. Z7.
G81 T12 L1
S150
G99 G01 X9.5 F3.
Z-4. F1.
S600
Z-13. F1.
X20. F3.
S0
G80
M30
"""


def flank_angles(vertices: np.ndarray, faces: np.ndarray, z: float, radius: float) -> np.ndarray:
    """(24,) sorted angles [deg] at which the section at z crosses a circle."""
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    segments = trimesh.intersections.mesh_plane(mesh, [0, 0, 1], [0, 0, z])[:, :, :2]
    inside = np.hypot(segments[..., 0], segments[..., 1]) < radius
    crossing = segments[inside[:, 0] != inside[:, 1]]
    r = np.hypot(crossing[..., 0], crossing[..., 1])
    share = (radius - r[:, :1]) / (r[:, 1:] - r[:, :1])
    points = crossing[:, 0] + share * (crossing[:, 1] - crossing[:, 0])
    return np.sort(np.degrees(np.arctan2(points[:, 1], points[:, 0])))


def test_flanks_shift_by_the_difference_of_the_lags(tmp_path: Path) -> None:
    (tmp_path / "job.toml").write_text(JOB, encoding="utf-8")
    (tmp_path / "program.nc").write_text(PROGRAM, encoding="utf-8")
    job = read_job(tmp_path)
    cutters = cutters_of(job)
    ready, settings = make_ready(job, cutters), settings_of(job, cutters)
    controller = Controller(
        parse_program(PROGRAM, file="program.nc"), parameters=settings.parameters, offsets=settings.offsets
    )
    session = record(controller, MujocoMachine(ready.tools[0].assembly), ready)
    assert not session.alarms
    part = cut(job.work.blank(), session.motions, cell_mm=0.35).remains
    front, back = (flank_angles(part.vertices, part.faces, z, 6.0) for z in (-0.7, -7.3))
    assert len(front) == len(back) == 24
    shift = (back - front + 180.0) % 360.0 - 180.0
    expected = (1 - 0.9) * ((600 - 150) / 12 * 6.0) / 80.0
    # work that turns in + and lags meets the hob with a place further round in +
    assert shift == pytest.approx(np.full(24, expected), rel=0.1)
