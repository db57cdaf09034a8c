"""A short polygon job, run under its own forces."""

from pathlib import Path

import numpy as np

from controller.language.source import parse_program
from twin.course import Course
from twin.cutters.cutter import Cutter
from twin.cutting.blank import Blank
from twin.cutting.field import DepthField
from twin.cutting.motion import CutterMotion
from twin.job import read_job
from twin.load.forces import Clock
from twin.load.loaded import LoadedRun, run_under_load
from twin.load.removal import Removal, removal
from twin.load.rounds import TICKS
from twin.load.stock import Stock
from twin.presets import cutters_of, settings_of
from twin.recording import Recording
from twin.session import Session, begin_program, session_of
from twin.setup import Ready, make_ready

JOB = """
[machine]
model = "hobbing_lathe"
[work]
diameter_mm = 20.0
length_mm = 2.0
clamping = "chuck"
material = "{material}"
[tool]
kind = "{tool}"
{size}
[program]
file = "program.nc"
[physics]
{physics}
"""
HEAD = "inserts = 3\ntip_radius_mm = 40.0\nedge_width_mm = 2.0"
PROGRAM = """O1
G54 G00 X26. Z-1.
G51.2 P3 Q6
S300
G99 G01 X{x} F1.
G01 X26. F2.
S0
G50.2
M30
"""


def metal_of(blank: Blank, tool: tuple[Cutter, CutterMotion], resolution_mm: float | None = None) -> Removal:
    """All metal that one tool takes off a whole blank."""
    return removal_of(Stock.of(blank, [tool[0]], resolution_mm), blank, tool)


def removal_of(stock: Stock, blank: Blank, tool: tuple[Cutter, CutterMotion]) -> Removal:
    """All metal that one tool takes off the stock of a blank."""
    cutter, motion = tool
    return removal(stock, DepthField(cutter, motion, blank.radius, blank.z_range), motion)


def clock_of(recording: Recording) -> Clock:
    tick = np.rint(recording.time_s / 1e-3).astype(np.int64) - 1
    return Clock(tick_s=1e-3, tick=tick, tool_angle_deg=recording.tool_angle_deg)


class Polygon:
    """The job, made ready."""

    def __init__(self, folder: Path, *, physics: str, x: float = 18.0, material: str = "16MnCr5") -> None:
        (folder / "program.nc").write_text(PROGRAM.format(x=x), encoding="utf-8")
        text = JOB.format(material=material, tool="polygon_head", size=HEAD, physics=physics)
        (folder / "job.toml").write_text(text, encoding="utf-8")
        self.job = read_job(folder)
        cutters = cutters_of(self.job)
        self.settings = settings_of(self.job, cutters)
        self.ready: Ready = make_ready(self.job, cutters, lowest_z_mm=-1.0)
        self.program = parse_program(PROGRAM.format(x=x), file="program.nc")

    def begin(self, *, ideal: bool = True) -> Course:
        return begin_program(self.program, self.settings, self.ready, ideal=ideal)

    def run(self, load=None, *, ideal: bool = True) -> Session:
        course = self.begin(ideal=ideal)
        course.go(load=load)
        return session_of(course, self.ready, load)

    def loaded(self, *, ideal: bool = True, ticks: int = TICKS) -> LoadedRun:
        course, foreseen = self.begin(ideal=ideal), self.begin(ideal=True)
        return run_under_load(self.job, self.ready, course, foreseen, ticks=ticks)
