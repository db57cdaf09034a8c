"""Where a cutter took metal as it must not: at rapid, at rest, or from work at rest in the gear box.

An alarm of the run, found when it is over: metal that is gone is known only from the recorded motion and all
cuts before. What is looked at is cheap first: stretches in which tool and blank come close at all, points of
the edges inside the blank, and only for those, which cuts have been there before.

A tool that leaves the stock at rapid goes on cutting a little while it turns, as a hob does that is drawn
back in mid-face. That is no clash: it counts only where the rapid brings the tool to places that it did not
reach from where it stood.
"""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from controller.span import Span
from controller.tables.alarms import Alarm
from twin.clashes.edges import AROUND, Places, edge_points, places
from twin.clashes.runs import Manner, Run, Ways, runs
from twin.clashes.standing import below_surface, standing
from twin.cutters.cutter import Cutter
from twin.cutting.blank import Blank
from twin.cutting.fields import Field, tool_field
from twin.cutting.motion import CutterMotion
from twin.session import Clash, Session

Floats = NDArray[np.float64]

TAKEN = 0.1
"""[mm] of metal below which edges only shave what feed and generating marks stand off"""
STEP = 0.5
"""[mm] that edges and stock go between two looks"""
POINTS = 3_000_000
"""of edges looked at in a run, at most"""
TOGETHER = 300_000
SUSPECTS = 600
"""points inside the blank that are held against the cuts before"""


def judged(blank: Blank, session: Session) -> Session:
    """The session with its clashes and their alarms."""
    found = clashes(blank, session)
    return replace(session, alarms=(*session.alarms, *(clash.alarm for clash in found)), clashes=found)


def clashes(blank: Blank, session: Session) -> tuple[Clash, ...]:
    """Every block in which a tool took metal the wrong way, in the order of time."""
    found: list[Clash] = []
    for number, (cutter, motion) in enumerate(session.motions):
        found += _of_tool(blank, session, number, cutter, motion)
    return tuple(sorted(found, key=lambda clash: clash.time_s))


def _of_tool(
    blank: Blank, session: Session, number: int, cutter: Cutter, motion: CutterMotion
) -> list[Clash]:
    """Every run of one stretch with one tool that takes metal."""
    recording = session.recording
    first = int(np.searchsorted(recording.time_s, motion.time_s[0]))
    rows = slice(first, first + len(motion.time_s))
    close = runs(
        cutter,
        motion,
        blank,
        block=recording.block[rows].astype(np.int64),
        rapid=session.rapid[rows],
        sync=recording.sync[rows],
    )
    fields: dict[int, Field] = {}
    said: list[Clash] = []
    blocks: set[int] = set()
    for run in close:
        suspects = _suspects(blank, cutter, motion, run)
        if not len(suspects.instant):
            continue
        for k in range(number + 1):
            if k not in fields:
                fields[k] = tool_field(*session.motions[k], blank.radius, blank.z_range)
        cuts = [(fields[k], math.inf if k < number else float(run.start)) for k in range(number + 1)]
        depth = np.minimum(
            standing(suspects.part, cuts, enough=TAKEN), below_surface(blank, suspects.part, TAKEN)
        )
        metal = np.flatnonzero(depth > TAKEN)
        if not len(metal):
            continue
        sample = suspects.instant[metal].min()
        block = int(recording.block[first + math.ceil(sample)])
        if block in blocks:
            continue
        blocks.add(block)
        time = float(np.interp(sample, np.arange(len(motion.time_s)), motion.time_s))
        ref = recording.blocks[block]
        tool = f"T{recording.tool[first]:02d}" if recording.tool[first] else "the tool"
        said.append(
            Clash(
                alarm=Alarm(
                    number=run.manner.value,
                    found=f"{tool} comes {depth[metal].max():.2f} mm deep into standing metal of the blank, "
                    f"at {time:.3f} s",
                    span=Span(file=ref.file, line=ref.line),
                ),
                time_s=time,
                point=suspects.work[metal[np.argmin(suspects.instant[metal])]],
            )
        )
    return said


def _suspects(blank: Blank, cutter: Cutter, motion: CutterMotion, run: Run) -> Places:
    """Points of edges that come into the blank during a run, and at rapid where the tool was not before."""
    axis = motion.basis[2]
    half = 0.5 * blank.length_mm * abs(axis[2]) + blank.radius * math.hypot(axis[0], axis[1])
    middle = np.array([0.0, 0.0, -0.5 * blank.length_mm])
    off = (middle - motion.centre[run.near]) @ axis
    edge = edge_points(cutter, float(off.min()) - half, float(off.max()) + half)
    edges = len(edge) * (AROUND if cutter.revolved else len(cutter.gash_angle))
    instant = _looks(blank, cutter, motion, run, edges)
    kept: list[Places] = []
    each = max(1, TOGETHER // max(1, edges))
    for low in range(0, len(instant), each):
        some = places(cutter, motion, edge, instant[low : low + each])
        inside = below_surface(blank, some.part, TAKEN) > TAKEN
        if run.manner is Manner.RAPID:
            inside &= _outside_of_tool(cutter, motion, run.start, some.work)
        kept.append(some.of(inside))
    found = Places.joined(kept)
    return found.of(np.arange(0, len(found.instant), max(1, math.ceil(len(found.instant) / SUSPECTS))))


def _looks(blank: Blank, cutter: Cutter, motion: CutterMotion, run: Run, points: int) -> Floats:
    """(n,) instants at which to look at so many points: every STEP of way, within what POINTS allow."""
    ways = Ways.of(cutter, motion, blank)
    tips = 0.0 if cutter.revolved else ways.tips  # an outline that is the same all around
    way = np.cumsum((tips + ways.stock + ways.slides)[run.near])
    count = min(math.ceil(way[-1] / STEP) + 1, max(2, POINTS // max(1, points)))
    # between samples that are not neighbours there is nothing to look at: instants keep to samples' ends
    wanted = np.linspace(0.0, way[-1], count)
    k = np.minimum(np.searchsorted(way, wanted), len(way) - 1)
    before = np.where(k > 0, way[np.maximum(k - 1, 0)], 0.0)
    share = (wanted - before) / np.maximum(way[k] - before, 1e-300)
    return np.maximum(run.near[k] - 1.0 + np.clip(share, 0.0, 1.0), 0.0)


def _outside_of_tool(cutter: Cutter, motion: CutterMotion, sample: int, points: Floats) -> NDArray[np.bool_]:
    """Whether points (n, 3) of the work frame are out of reach of the tool as it stood at a sample."""
    rel = points - motion.centre[sample]
    along = rel @ motion.basis[2]
    across = np.linalg.norm(rel - along[:, None] * motion.basis[2], axis=1)
    return (across > cutter.radius + TAKEN) | (np.abs(along - cutter.shift) > cutter.half_length + TAKEN)
