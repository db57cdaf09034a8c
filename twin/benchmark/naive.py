"""What the kernel is held against: a boolean for every tooth pass, and one boolean of finished gaps."""

import math
import time
from collections.abc import Callable

import manifold3d
import numpy as np
from numpy.typing import NDArray

from twin.benchmark.cases import Case
from twin.cutters.profile import ToothProfile
from twin.cutting.blank import Blank
from twin.cutting.field import DepthField
from twin.cutting.stock import blank_solid, solid

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

CHORD = 1e-3
"""[mm] by which facets may leave the tips' circle, as the kernel's may leave the flank"""
BATCH = 96
"""Sweeps in one boolean: larger ones and smaller ones take longer."""
TURNS = 2
"""Turns of the work that are cut, in the middle of the blank."""
HEIGHTS = 12
"""Points on each flank of a tooth's outline."""
LOFT = (60, 220)
"""Points around and along each of the finished gaps: 26 400 triangles"""


def naive_seconds(case: Case, share: Callable[[float], None] = lambda _done: None) -> float:
    """Seconds to subtract every tooth pass, from TURNS steady turns of the work."""
    motion, blank = case.motion, case.blank
    field = DepthField(case.cutter, motion, blank.radius, blank.z_range)
    deep = np.argmin(np.abs(motion.centre[:, 2] + 0.5 * blank.length_mm))
    work = np.abs(motion.work_angle - motion.work_angle[deep])
    samples = np.flatnonzero(work <= TURNS * math.pi)
    inside = (field.passes.at >= samples[0]) & (field.passes.at <= samples[-1])
    teeth = np.unique(field.tooth)
    start = time.perf_counter()
    left = blank_solid(blank)
    sweeps: list[manifold3d.Manifold] = []
    indices = np.flatnonzero(inside)
    for number, index in enumerate(indices):
        share(number / len(indices))
        for tooth in teeth:
            swept = _sweep(case, field, int(index), int(tooth))
            if swept is not None:
                sweeps.append(swept)
        if len(sweeps) >= BATCH:
            left = manifold3d.Manifold.batch_boolean([left, *sweeps], manifold3d.OpType.Subtract)
            left.num_tri()
            sweeps = []
    if sweeps:
        left = manifold3d.Manifold.batch_boolean([left, *sweeps], manifold3d.OpType.Subtract)
    left.num_tri()
    return (time.perf_counter() - start) * case.turns / TURNS


def _sweep(case: Case, field: DepthField, index: int, tooth: int) -> manifold3d.Manifold | None:
    """What one tooth sweeps in one pass, while it can touch the blank; None where it does not."""
    cutter, motion, blank = case.cutter, case.motion, case.blank
    passes, profile = field.passes, cutter.profile
    outline = _outline(profile)
    pitch = profile.pitch if math.isfinite(profile.pitch) else 0.0
    apart = float(np.hypot(*motion.centre[0, :2])) - blank.radius
    half = math.acos(min(max(apart / profile.tip, -1.0), 1.0)) + 0.05
    steps = max(math.ceil(half / math.acos(1.0 - CHORD / profile.tip)), 2)
    turn = np.linspace(-half, half, steps + 1)
    samples = np.arange(len(motion.tool_angle), dtype=np.float64)
    at = np.interp(passes.angle[index] + turn, motion.tool_angle, samples)
    centre = np.stack([np.interp(at, samples, column) for column in motion.centre.T], axis=1)
    work = np.interp(at, samples, motion.work_angle)
    s = outline[:, 0] + tooth * pitch + passes.shift[index]
    rho = outline[:, 1]
    local = np.stack(
        [
            np.cos(turn)[:, None] * rho,
            np.sin(turn)[:, None] * rho,
            np.broadcast_to(s, (len(turn), len(s))),
        ],
        axis=-1,
    )
    lab = local @ motion.basis + centre[:, None]
    cos, sin = np.cos(work)[:, None], np.sin(work)[:, None]
    points = np.stack(
        [lab[..., 0] * cos + lab[..., 1] * sin, lab[..., 1] * cos - lab[..., 0] * sin, lab[..., 2]], axis=-1
    )
    low, high = blank.z_range
    near = (np.hypot(points[..., 0], points[..., 1]) < blank.radius) & (points[..., 2] > low)
    if not (near & (points[..., 2] < high)).any():
        return None
    made = solid(points.reshape(-1, 3), _loft(len(turn), len(s)))
    return made if made.volume() > 0 else solid(points.reshape(-1, 3), _loft(len(turn), len(s))[:, ::-1])


def _outline(profile: ToothProfile) -> Floats:
    """A tooth (n, 2) of (s, rho), from its land on one side over the tip to the other; closed below."""
    bottom = max(profile.root, profile.tip - 3.0 * profile.half_width)
    rho = np.linspace(bottom, profile.tip - 1e-6, HEIGHTS)
    low, high = np.zeros(HEIGHTS), np.full(HEIGHTS, profile.half_width)
    for _ in range(40):
        middle = 0.5 * (low + high)
        inside = profile.depth(middle, rho)[0] > 0
        low, high = np.where(inside, middle, low), np.where(inside, high, middle)
    right = np.stack([np.maximum(low, 1e-6), rho], axis=1)
    return np.concatenate([right * [-1.0, 1.0], right[::-1]])


def _loft(along: int, around: int) -> Ints:
    """Triangles of a closed loft of `along` rings of `around` points that are convex enough for a fan."""
    number = np.arange(along * around).reshape(along, around)
    after = np.roll(number, -1, axis=1)
    a, b, c, d = number[:-1], after[:-1], after[1:], number[1:]
    sides = np.concatenate([np.stack([a, b, c], axis=-1), np.stack([a, c, d], axis=-1)]).reshape(-1, 3)
    # a ladder from flank to flank
    left = np.arange(around // 2 - 1)
    right = around - 1 - left
    rungs = np.concatenate(
        [np.stack([left, left + 1, right - 1], axis=1), np.stack([left, right - 1, right], axis=1)]
    )
    return np.concatenate([sides, number[0][rungs][:, ::-1], number[-1][rungs]])


def boolean_seconds(count: int = 20) -> float:
    """Seconds of one boolean: a blank without `count` wavy prisms of 26 400 triangles each."""
    around, along = LOFT
    angle = np.linspace(0, 2 * math.pi, around, endpoint=False)
    z = np.linspace(-21, 1, along + 1)
    size = 1.2 + 0.01 * np.sin(3 * z)
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    lofts = []
    for n in range(count):
        turn = 2 * math.pi * n / count
        middle = 21.5 * np.array([math.cos(turn), math.sin(turn)])
        xy = middle + size[:, None, None] * ring
        rows = np.concatenate([xy, np.broadcast_to(z[:, None, None], (along + 1, around, 1))], axis=2)
        vertices = np.concatenate([rows.reshape(-1, 3), [[*middle, z[0]], [*middle, z[-1]]]])
        k = np.arange(along)[:, None] * around
        a, b = k + np.arange(around), k + (np.arange(around) + 1) % around
        c, d = a + around, b + around
        last = len(vertices)
        bottom = np.stack([b[0], a[0], np.full(around, last - 2)], axis=1)
        top = np.stack([c[-1], d[-1], np.full(around, last - 1)], axis=1)
        sides = np.concatenate([np.stack([a, b, d], axis=-1), np.stack([a, d, c], axis=-1)]).reshape(-1, 3)
        lofts.append(solid(vertices, np.concatenate([sides, bottom, top])))
    blank = blank_solid(Blank(diameter_mm=44.0, length_mm=20.0))
    start = time.perf_counter()
    manifold3d.Manifold.batch_boolean([blank, *lofts], manifold3d.OpType.Subtract).num_tri()
    return time.perf_counter() - start
