"""The cuts that the kernel is timed on: ideal motions in closed form."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutters.cutter import Cutter
from twin.cutters.hob import Hob
from twin.cutters.polygon_head import PolygonHead
from twin.cutting.blank import Blank
from twin.cutting.motion import CutterMotion

Floats = NDArray[np.float64]

TICK = 1e-3
"""[s] between two samples"""
TOOL_RPM = 300.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """A blank, a tool and its motion."""

    blank: Blank
    cutter: Cutter
    motion: CutterMotion
    turns: float
    """of the work, in all"""


def gear_case(
    *,
    module: float,
    teeth: int,
    width: float,
    helix_deg: float = 0.0,
    hob_diameter: float,
    feed: float = 2.0,
) -> Case:
    """A gear of full depth, hobbed in one pass with a right-hand hob of one start and twelve gashes."""
    hob = Hob(normal_module_mm=module, outside_diameter_mm=hob_diameter, gashes=12)
    helix = math.radians(helix_deg)
    reference = module * teeth / math.cos(helix)
    outside, root = reference + 2.0 * module, reference - 2.5 * module
    # the swivelled hob is as long as its teeth reach the blank
    run = math.sqrt(2.25 * module * hob_diameter) + 2.0 * module
    run += 0.5 * math.sqrt(outside**2 - root**2) * abs(math.sin(helix))
    turns = (width + 2.0 * run) / feed
    tool = np.arange(0.0, 2.0 * math.pi * turns * teeth, TOOL_RPM / 60.0 * 2.0 * math.pi * TICK)
    height = run - (width + 2.0 * run) * tool / tool[-1]
    work = tool / teeth - 2.0 * (height - run) * math.sin(helix) / (module * teeth)
    cutter = hob.cutter(helix - hob.lead_angle)
    middle = 0.5 * (root + hob_diameter)
    return Case(
        blank=Blank(diameter_mm=outside, length_mm=width, bore_mm=0.3 * reference),
        cutter=cutter,
        motion=_motion(cutter, work, tool, middle, height),
        turns=turns,
    )


def hexagon_case(*, across: float = 17.0, width: float = 12.0, feed: float = 0.5) -> Case:
    """A hexagon by three inserts at twice the speed of the work."""
    head = PolygonHead(inserts=3, tip_radius_mm=40.0)
    turns = (width + 4.0) / feed
    work = np.arange(0.0, 2.0 * math.pi * turns, TOOL_RPM / 60.0 * math.pi * TICK)
    height = 2.0 - (width + 4.0) * work / work[-1]
    cutter = head.cutter()
    return Case(
        blank=Blank(diameter_mm=1.12 * across, length_mm=width),
        cutter=cutter,
        motion=_motion(cutter, work, 2.0 * work, 0.5 * across + head.tip_radius_mm, height),
        turns=turns,
    )


def _motion(cutter: Cutter, work: Floats, tool: Floats, middle: float, height: Floats) -> CutterMotion:
    axis = np.array([0.0, -math.sin(cutter.swivel), math.cos(cutter.swivel)])
    towards = np.array([-1.0, 0.0, 0.0])
    n = len(work)
    return CutterMotion(
        time_s=TICK * np.arange(n, dtype=np.float64),
        work_angle=work,
        tool_angle=tool,
        centre=np.column_stack([np.full(n, middle), np.zeros(n), height]),
        basis=np.array([towards, np.cross(axis, towards), axis]),
    )


CASES: dict[str, Callable[[], Case]] = {
    "spur_m2_z20_b20": lambda: gear_case(module=2.0, teeth=20, width=20.0, hob_diameter=70.0),
    "m1_z80_b15": lambda: gear_case(module=1.0, teeth=80, width=15.0, hob_diameter=50.0),
    "m3_z40_b40_beta30": lambda: gear_case(
        module=3.0, teeth=40, width=40.0, helix_deg=30.0, hob_diameter=80.0
    ),
    "hexagon": hexagon_case,
}
"""Name -> case"""
