"""A gear hobbed with rigid axes on the machine of a job, and its flanks felt by rays."""

import importlib
import math
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from twin.cutting.fields import tool_field
from twin.cutting.rays import crossings
from twin.faults.encoders import stands
from twin.inspection.involute import geometry
from twin.job import read_job
from twin.kinematics import cutter_motion
from twin.presets import cutters_of
from twin.setup import make_ready

# the independent evaluator of the kernel's tests
sys.path.insert(0, str(Path(__file__).parents[1] / "cutting"))

JOB = """
[work]
diameter_mm = {tip}
length_mm = {length}
[tool]
kind = "hob"
normal_module_mm = {module}
outside_diameter_mm = {hob}
starts = {starts}
gashes = {gashes}
[program]
file = "program.nc"
[nominal]
kind = "gear"
number_of_teeth = {teeth}
normal_module_mm = {module}
helix_angle_deg = {helix}
[faults]
{faults}
"""


@pytest.fixture(scope="session")
def brute_force():
    """The independent evaluator."""
    return importlib.import_module("brute_force")


@dataclass(frozen=True, kw_only=True)
class Hobbed:
    """A gear as it is cut, not meshed; a gap stands at +X in its front face's plane at z = 0."""

    gear: object
    cutter: object
    motion: object
    field: object
    length: float

    def nominal(self, tooth, side, radius, z):
        """Points and outward base tangents of the flanks; gap 0 stands at +X, `side` +1 = left flank."""
        gear = self.gear
        centre = math.pi / gear.teeth - 2 * math.pi * np.asarray(tooth) / gear.teeth
        angle = centre + gear.twist * z + side * gear.half_tooth(radius)
        points = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), z + 0 * angle])
        roll = np.arccos(np.minimum(gear.base_radius / radius, 1.0))
        way = angle + side * (math.pi / 2 - roll)
        return points, np.column_stack([np.cos(way), np.sin(way), 0 * way])

    def deviation(self, tooth, side, radius, z, reach=0.3):
        """[µm] tangent to the base circle, + = material outside."""
        shape = np.broadcast_shapes(*(np.shape(v) for v in (tooth, side, radius, z)))
        values = [np.broadcast_to(v, shape).ravel() for v in (tooth, side, radius, z)]
        points, along = self.nominal(*values)
        return 1e3 * crossings((self.field,), points, along, reach=reach).reshape(shape)


@pytest.fixture(scope="session")
def hobbed(tmp_path_factory):
    """Cut a gear by a job's machine with rigid axes; keyword arguments are the job's."""

    def cut(
        faults="",
        *,
        module=2.0,
        teeth=20,
        helix=0.0,
        length=4.0,
        feed=1.0,
        hob=70.0,
        starts=1,
        gashes=12,
        speed=300.0,
        step_deg=6.0,
        over=None,
        encoders=None,
    ):
        folder = tmp_path_factory.mktemp("job")
        (folder / "program.nc").write_text("M30\n", encoding="utf-8")
        gear_nominal = module * teeth / math.cos(math.radians(helix))
        text = JOB.format(
            tip=gear_nominal + 2 * module,
            length=length,
            module=module,
            hob=hob,
            starts=starts,
            gashes=gashes,
            teeth=teeth,
            helix=helix,
            faults=faults,
        )
        (folder / "job.toml").write_text(text, encoding="utf-8")
        job = read_job(folder)
        cutters = cutters_of(job)
        mounted = make_ready(job, cutters).tools[0]
        # one pass, long enough that the hob enters and leaves clear of the face
        over = 2 * feed + 0.4 if over is None else over
        turns = (length + 2 * over) / feed * teeth / starts
        tool = np.arange(0.0, 360.0 * turns, step_deg)
        z = over - (length + 2 * over) * tool / (360.0 * turns)
        work = tool * starts / teeth
        # a right-hand gear turns back as the tool rises
        work = work - np.degrees(2 * z * math.sin(math.radians(helix)) / (module * teeth))
        x = gear_nominal / 2 - 1.25 * module - job.setup.reference.X / 2
        axes = np.column_stack([np.full(len(z), x), z - job.setup.reference.Z, tool, work])
        motion = cutter_motion(mounted.kinematics, tool / (6.0 * speed), stands(encoders or {}, axes))
        blank = job.work.blank()
        return Hobbed(
            gear=geometry(job.nominal),
            cutter=mounted.cutter,
            motion=motion,
            field=tool_field(mounted.cutter, motion, blank.radius, blank.z_range),
            length=length,
        )

    return cut
