"""The metal that edges take away, piece by piece: how much, when, where, how thick, and which way they go.

The stock is a brush of rays from the work axis outwards, each as long as the metal that stands on it. Edges
come from outside: a pass cuts a ray off where its depth along it is zero. Rays see all of a chip's area, and
its thickness exactly, however thin it is. Metal that hangs over an undercut goes with what holds it up.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from twin.cutters.cutter import Cutter
from twin.cutting.blank import Blank
from twin.cutting.chips import SIMPSON
from twin.cutting.field import DepthField
from twin.cutting.motion import CutterMotion
from twin.cutting.pairs import batches, in_parallel
from twin.cutting.passes import REACH
from twin.load.ray_ends import SLACK, cut_at
from twin.load.stock import Stock

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Tools = tuple[tuple[Cutter, CutterMotion], ...]

PASSES = 12
"""looked at together, at most"""
FAR = 1e4
"""[mm] longer than any ray"""
THINNEST = 1e-7
"""[mm] of metal that counts as some"""
ROUNDING = 1e-9
"""[rad]"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Removal:
    """Pieces of the removed metal, in the order of time by stretches. Frame: that of the work, which does not
    turn."""

    chip: Ints
    """(n, 3) the chip that it belongs to: stretch with one tool, pass, tooth along the edge"""
    volume_mm3: Floats
    """(n,)"""
    height_mm: Floats
    """(n,) mean height of the metal above the edge that takes it"""
    time_s: Floats
    """(n, 2) when the edge comes to it, and when it is through"""
    place_mm: Floats
    """(n, 3) where the edge meets the middle of the piece"""
    lever_mm: Floats
    """(n, 3) the same from the tool's centre"""
    speed: Floats
    """(n, 3) of the edge against the metal [mm/s]"""
    push: Floats
    """(n, 2) unit vector in the rake plane from the metal beyond into the edge, normal to it: components
    along the tool's axis and away from it"""
    resolution_mm: float

    def thickness_mm(self) -> Floats:
        """(n,) mean thickness of the chip that each piece belongs to: twice the metal's mean height."""
        _, chip = np.unique(self.chip, axis=0, return_inverse=True)
        chip = chip.reshape(-1)
        total = np.bincount(chip, self.volume_mm3)
        mean = np.bincount(chip, self.volume_mm3 * self.height_mm) / np.maximum(total, 1e-300)
        return 2.0 * mean[chip]


def removal(
    blank: Blank,
    tools: Tools,
    *,
    resolution_mm: float | None = None,
) -> Removal:
    """The metal that the tools take away from a blank; `resolution_mm` is the distance of the rays on its
    surface.

    Raises InputError for a resolution that would need too much memory or time.
    """
    stock = Stock.of(blank, [cutter for cutter, _ in tools], resolution_mm)
    fields_of = [DepthField(cutter, motion, blank.radius, blank.z_range) for cutter, motion in tools]
    return cut_off(stock, [(one, np.arange(one.passes.count)) for one in fields_of], [m for _, m in tools])


def cut_off(
    stock: Stock, passes: Sequence[tuple[DepthField, Ints]], motions: Sequence[CutterMotion]
) -> Removal:
    """What some passes of each stretch's field, stretch by stretch, take off the stock; it is cut."""
    names = [f.name for f in fields(Removal) if f.name != "resolution_mm"]
    shapes = {"chip": (0, 3), "time_s": (0, 2), "push": (0, 2)}
    shapes |= dict.fromkeys(("place_mm", "lever_mm", "speed"), (0, 3))
    parts = {
        name: [np.zeros(shapes.get(name, (0,)), np.int64 if name == "chip" else float)] for name in names
    }
    for number, ((field, index), motion) in enumerate(zip(passes, motions, strict=True)):
        for first in range(0, len(index), PASSES):
            for name, values in _cut(field, motion, stock, index[first : first + PASSES], number).items():
                parts[name].append(values)
    return Removal(**{name: np.concatenate(parts[name]) for name in names}, resolution_mm=stock.step)


def _cut(
    field: DepthField, motion: CutterMotion, rays: Stock, passes: Ints, stretch: int
) -> dict[str, NDArray]:
    """What some passes that follow one another take off the rays; the rays are cut."""
    ray, index = _met(field, motion, rays, passes)
    parts = batches(np.arange(len(ray) + 1))
    ends = in_parallel(lambda part: cut_at(field, rays, ray[part], index[part]), parts)
    end = np.concatenate([np.zeros(0), *ends])
    # on each ray only what stands when its pass comes: the shortest that earlier passes have left
    order = np.lexsort((index, ray))
    ray, index, end = ray[order], index[order], end[order]
    start = _shortest_before(ray, rays.end[ray], end)
    some = np.flatnonzero(end < start - THINNEST)
    ray, index, end, start = ray[some], index[some], end[some], start[some]
    np.minimum.at(rays.end, ray, end)
    return _seen(field, motion, rays, (ray, index, end, start), stretch)


def _met(field: DepthField, motion: CutterMotion, rays: Stock, passes: Ints) -> tuple[Ints, Ints]:
    """Pairs of rays and passes whose edges come to the rays' ends or further in."""
    p = field.passes
    work, centre = _at(motion, motion.work_angle, p.at[passes]), _at(motion, motion.centre, p.at[passes])
    standing = _facing(field, motion, rays, (work, centre[:, 0], p.travel[passes]))
    place = motion.mount.moved(rays.points(standing, rays.end[standing]))
    x, y, z = place.T
    towards, across = motion.basis[0], motion.basis[1]
    rows: list[tuple[Ints, Ints]] = []
    for index, turned, middle in zip(passes, work, centre, strict=True):
        cos, sin = math.cos(turned), math.sin(turned)
        off_x, off_y, off_z = x * cos - y * sin - middle[0], x * sin + y * cos - middle[1], z - middle[2]
        a = off_x * towards[0] + off_y * towards[1] + off_z * towards[2]
        b = off_x * across[0] + off_y * across[1] + off_z * across[2]
        # the sooner or later the edge comes, the further the stock has gone on
        way = p.travel[index] * np.minimum(np.abs(np.arctan2(b, a)) / REACH, 1.0) + SLACK
        ray = standing[np.hypot(a, b) < field.cutter.radius + way]
        rows.append((ray, np.full(len(ray), index)))
    return np.concatenate([ray for ray, _ in rows]), np.concatenate([index for _, index in rows])


def _facing(
    field: DepthField, motion: CutterMotion, rays: Stock, seen: tuple[Floats, Floats, Floats]
) -> Ints:
    """Rays that still stand, and on the side of the work where some passes' edges can come to them: `seen`
    are work angle, distance of the axes and the stock's travel (n,) of each.

    Metal at an angle φ from the tool stands at most its radius · cos φ nearer to it, and what the clamping
    shifts.
    """
    work, away, travel = seen
    high = float(rays.end.max(initial=0.0))
    farthest = math.hypot(high, float(np.abs(rays.z).max(initial=0.0)))
    shift = np.linalg.norm(motion.mount.rotation - np.eye(3), 2) * farthest
    shift += np.linalg.norm(motion.mount.translation)
    least = float((away - travel).min()) - field.cutter.radius - SLACK - float(shift)
    standing = rays.end > rays.inner
    if least > 0.0 and np.allclose(motion.basis[0], [-1.0, 0.0, 0.0]):
        half = math.acos(min(least / high, 1.0)) + 0.5 * float(np.ptp(work)) + ROUNDING
        middle = -0.5 * float(work.min() + work.max())
        if half < math.pi:
            standing &= rays.cos * math.cos(middle) + rays.sin * math.sin(middle) >= math.cos(half)
    return np.flatnonzero(standing)


def _at(motion: CutterMotion, values: Floats, sample: Floats) -> Floats:
    """Values (n, ...) of a motion at fractional samples (m,)."""
    cell = np.clip(sample.astype(np.int64), 0, len(motion.time_s) - 2)
    share = (sample - cell).reshape(-1, *[1] * (values.ndim - 1))
    return values[cell] + share * (values[cell + 1] - values[cell])


def _shortest_before(ray: Ints, standing: Floats, end: Floats) -> Floats:
    """(n,) what stands of each ray when each pass comes; pairs in the order of rays, then passes."""
    same = np.diff(ray, prepend=-1) == 0
    # a running minimum that begins anew with each ray: every ray lies far below the one before
    drop = FAR * np.cumsum(~same)
    left = np.minimum.accumulate(np.minimum(standing, end) - drop) + drop
    return np.where(same, np.roll(left, 1), standing)


def _seen(
    field: DepthField,
    motion: CutterMotion,
    rays: Stock,
    pieces: tuple[Ints, Ints, Floats, Floats],
    stretch: int,
) -> dict[str, NDArray]:
    """Pieces of rays, from their ends to where they stood, as the edges see them that take them away."""
    ray, index, end, start = pieces
    middle = 0.5 * (end + start)
    met = [field.evaluate(rays.points(ray, radius), index) for radius in (end, middle, start)]
    height = np.stack([np.maximum(meeting.depth, 0.0) for meeting in met], axis=1) @ SIMPSON
    pitch = field.cutter.profile.pitch
    tooth = (
        np.rint(met[1].s / pitch).astype(np.int64) if math.isfinite(pitch) else np.zeros(len(ray), np.int64)
    )
    # the edge that has left the new surface is the one that bears the force
    _, by_s, by_rho = field.cutter.profile.depth(met[0].s, met[0].rho)
    place, lever, speed = _edge(motion, rays.points(ray, middle), met[1].instant)
    # the edge needs some time to cross the ray's own breadth and height as well
    ends = np.stack([met[0].instant, met[1].instant, met[2].instant])
    ends = _at(motion, motion.time_s, ends.reshape(-1)).reshape(ends.shape)
    around = speed[:, 1] * place[:, 0] - speed[:, 0] * place[:, 1]
    across = np.abs(speed[:, 2]) * rays.rise + np.abs(around) * rays.turn
    half = 0.5 * across / np.maximum((speed * speed).sum(axis=1), 1e-12)
    return {
        "chip": np.column_stack([np.full(len(ray), stretch), index, tooth]),
        "volume_mm3": 0.5 * (start * start - end * end) * rays.turn * rays.rise,
        "height_mm": height,
        "time_s": np.column_stack([ends.min(axis=0) - half, ends.max(axis=0) + half]),
        "place_mm": place,
        "lever_mm": lever,
        "speed": speed,
        "push": np.column_stack([by_s, by_rho]),
    }


def _edge(motion: CutterMotion, points: Floats, instant: Floats) -> tuple[Floats, Floats, Floats]:
    """Where points (n, 3) of the part stand at fractional samples, as seen from the work spindle and from the
    tool's centre [mm], and how fast the edge that meets them there passes them [mm/s]."""
    cell = np.clip(instant.astype(np.int64), 0, len(motion.time_s) - 2)
    share = (instant - cell)[:, None]
    step = np.diff(motion.time_s)[cell][:, None]

    def at(values: Floats) -> tuple[Floats, Floats]:
        low, high = values[cell], values[cell + 1]
        return low + share * (high - low), (high - low) / step

    work, work_rate = at(motion.work_angle[:, None])
    _, tool_rate = at(motion.tool_angle[:, None])
    centre, feed = at(motion.centre)
    x, y, z = motion.mount.moved(points).T[:, :, None]
    cos, sin = np.cos(work), np.sin(work)
    place = np.hstack([x * cos - y * sin, x * sin + y * cos, z])
    lever = place - centre
    edge = feed + tool_rate * np.cross(motion.basis[2], lever)
    metal = work_rate * np.cross(np.array([0.0, 0.0, 1.0]), place)
    return place, lever, edge - metal
