"""Motions of an ideal machine in closed form, and ways to spoil them as a real one does."""

import math
from dataclasses import replace

import numpy as np

from twin.cutting.motion import CutterMotion, RigidTransform


def tool_basis(swivel):
    """Rows: tool angle 0 (towards the work), across, tool axis; `swivel` about X [rad], 0 = along +Z."""
    axis = np.array([0.0, -math.sin(swivel), math.cos(swivel)])
    towards_work = np.array([-1.0, 0.0, 0.0])
    return np.array([towards_work, np.cross(axis, towards_work), axis])


def hobbing(hob, *, teeth, helix_deg=0.0, tip_x, z, feed, step_deg, ratio_factor=1.0, swivel_error=0.0):
    """Hobbing with rigid axes: tool tips at radius `tip_x` of the work, centre fed from z[0] to z[1].

    `feed` is the travel per turn of the work, `step_deg` the hob's turn between two samples.
    """
    helix = math.radians(helix_deg)
    turns = abs(z[1] - z[0]) / feed * teeth / hob.starts
    samples = math.ceil(turns * 360.0 / step_deg) + 1
    tool = np.radians(step_deg) * np.arange(samples)
    height = np.linspace(z[0], z[1], samples)
    # a right-hand gear turns back as the tool rises: ΔC = −ΔZ sin β / (m_n z / 2)
    work = ratio_factor * hob.starts / teeth * tool
    work = work - 2.0 * (height - z[0]) * math.sin(helix) / (hob.normal_module_mm * teeth)
    centre = np.column_stack(
        [np.full(samples, tip_x + hob.outside_diameter_mm / 2.0), np.zeros(samples), height]
    )
    cutter = hob.cutter(helix - hob.lead_angle + swivel_error)
    motion = CutterMotion(
        time_s=1e-3 * np.arange(samples),
        work_angle=work,
        tool_angle=tool,
        centre=centre,
        basis=tool_basis(cutter.swivel),
    )
    return cutter, motion


def polygon_turning(head, *, ratio, across_flats, work_turns, z, step_deg):
    """Polygon turning with rigid axes: tool angle = `ratio` × work angle, z from z[0] to z[1]."""
    samples = math.ceil(work_turns * 360.0 / step_deg) + 1
    work = np.radians(step_deg) * np.arange(samples)
    centre = np.column_stack(
        [
            np.full(samples, across_flats / 2.0 + head.tip_radius_mm),
            np.zeros(samples),
            np.linspace(z[0], z[1], samples),
        ]
    )
    motion = CutterMotion(
        time_s=1e-3 * np.arange(samples),
        work_angle=work,
        tool_angle=ratio * work,
        centre=centre,
        basis=tool_basis(0.0),
    )
    return head.cutter(), motion


def grinding(wheel, *, teeth, module, helix_deg=0.0, tip_x, z, gaps, samples=80):
    """Single indexing: in each gap one stroke from z[0] to z[1] at depth, a way out, back, and round."""
    helix = math.radians(helix_deg)
    out = tip_x + 0.3 * wheel.outside_diameter_mm
    stroke = np.linspace(z[0], z[1], samples)
    heights = np.concatenate([stroke, np.full(10, z[1]), np.linspace(z[1], z[0], 10)])
    reach = np.concatenate([np.full(samples, tip_x), np.linspace(tip_x, out, 10), np.full(10, out)])
    n = gaps * len(heights)
    height, x = np.tile(heights, gaps), np.tile(reach, gaps)
    gap = np.repeat(np.arange(gaps), len(heights))
    # the last moves of each gap turn the work on to the next
    share = np.tile(np.concatenate([np.zeros(samples + 10), np.linspace(0.0, 1.0, 10)]), gaps)
    work = 2.0 * math.pi / teeth * (gap + share)
    work = work - 2.0 * (height - z[0]) * math.sin(helix) / (module * teeth)
    cutter = wheel.cutter(helix)
    motion = CutterMotion(
        time_s=1e-3 * np.arange(n),
        work_angle=work,
        tool_angle=0.3 * np.arange(n),
        centre=np.column_stack([x + wheel.outside_diameter_mm / 2.0, np.zeros(n), height]),
        basis=tool_basis(cutter.swivel),
    )
    return cutter, motion


def at_speed(motion, speed):
    """The same motion resampled so that it runs at `speed` (samples per sample, one value per new sample)."""
    clock = np.concatenate([[0.0], np.cumsum(speed)])
    old = np.arange(len(motion.time_s), dtype=float)
    if clock.min() < 0 or clock.max() > old[-1]:
        raise ValueError(f"the clock runs from {clock.min():g} to {clock.max():g}, expected 0 to {old[-1]:g}")

    def moved(values):
        return np.interp(clock, old, values)

    return replace(
        motion,
        time_s=1e-3 * np.arange(len(clock)),
        work_angle=moved(motion.work_angle),
        tool_angle=moved(motion.tool_angle),
        centre=np.stack([moved(column) for column in motion.centre.T], axis=1),
    )


def jittered(motion, rng, *, slide=2e-4, work=1e-5, tool=2e-5):
    """The same motion with servo noise between the samples: slides [mm], spindles [rad]."""
    n = len(motion.time_s)
    return replace(
        motion,
        work_angle=motion.work_angle + work * rng.standard_normal(n),
        tool_angle=motion.tool_angle + tool * rng.standard_normal(n),
        centre=motion.centre + slide * rng.standard_normal((n, 3)),
    )


def clamped(motion, *, eccentricity, tilt, direction=0.7):
    """The same motion past a part that is clamped off the axis [mm] and askew [rad]."""
    lean = direction + 0.4
    axis = np.array([math.cos(lean), math.sin(lean), 0.0])
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    rotation = np.eye(3) + math.sin(tilt) * cross + (1.0 - math.cos(tilt)) * cross @ cross
    shift = eccentricity * np.array([math.cos(direction), math.sin(direction), 0.0])
    return replace(motion, mount=RigidTransform(rotation=rotation, translation=shift))
