"""The metal that edges take away, piece by piece: how much, when, where, how thick, and which way they go.

The stock is a brush of rays from the work axis outwards, each as long as the metal that stands on it. Edges
come from outside: a pass cuts a ray off where its depth along it is zero. Rays see all of a chip's area, and
its thickness exactly, however thin it is. Metal that hangs over an undercut goes with what holds it up.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from twin.cutting.field import DepthField
from twin.cutting.motion import CutterMotion
from twin.cutting.pairs import batches, in_parallel
from twin.load.contacts import CLOSE_BY, Contacts
from twin.load.ray_ends import Ends, cut_at, followed
from twin.load.reach import Reach, at_samples
from twin.load.stock import Stock

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

PASSES = 12
"""looked at together, at most"""
FAR = 1e4
"""[mm] longer than any ray"""
THINNEST = 1e-7
"""[mm] of metal that counts as some"""
ALWAYS = (-math.inf, math.inf)


@dataclass(frozen=True, slots=True, kw_only=True)
class Removal:
    """Pieces of the removed metal, each of one ray and one pass. Frame: the work's, which does not turn."""

    index: Ints
    """(n,) the pass that takes it"""
    ray: Ints
    """(n,) that it is of"""
    end_mm: Floats
    """(n,) where the ray is cut off"""
    volume_mm3: Floats
    """(n,)"""
    thickness_mm: Floats
    """(n,) of the chip there: how far metal reaches from the edge that leaves the new surface"""
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

    @classmethod
    def none(cls) -> "Removal":
        """Not a piece."""
        shapes = {"time_s": (0, 2), "push": (0, 2)} | dict.fromkeys(("place_mm", "lever_mm", "speed"), (0, 3))
        kinds = {"index": np.int64, "ray": np.int64}
        return cls(
            **{f.name: np.zeros(shapes.get(f.name, (0,)), kinds.get(f.name, float)) for f in fields(cls)}
        )

    @property
    def middle_s(self) -> Floats:
        """(n,) when the edge is in the middle of the piece."""
        return self.time_s.mean(axis=1)

    @classmethod
    def joined(cls, parts: list["Removal"]) -> "Removal":
        """Pieces one after the other."""
        names = [f.name for f in fields(cls)]
        parts = [cls.none(), *parts]
        return cls(**{name: np.concatenate([getattr(part, name) for part in parts]) for name in names})

    def of(self, rows: Bools) -> "Removal":
        """Some of the pieces."""
        return Removal(**{f.name: getattr(self, f.name)[rows] for f in fields(Removal)})

    def in_time(self, between: tuple[float, float]) -> "Removal":
        """Those in the middle of which the edge is from one time to another [s]."""
        middle = self.middle_s
        return self.of((middle >= between[0]) & (middle < between[1]))

    def taken_from(self, stock: Stock) -> Stock:
        """What they leave of the stock."""
        left = stock.copy()
        np.minimum.at(left.end, self.ray, self.end_mm)
        return left


def removal(
    stock: Stock, field: DepthField, motion: CutterMotion, between: tuple[float, float] = ALWAYS
) -> Removal:
    """What the passes of a field take off the stock from one time to another [s]."""
    return looked_for(stock, field, motion, between)[0]


def looked_for(
    stock: Stock,
    field: DepthField,
    motion: CutterMotion,
    between: tuple[float, float] = ALWAYS,
    spare_s: float = 0.0,
) -> tuple[Removal, Contacts]:
    """The same, and every contact up to `spare_s` before and after."""
    parts = list(pieces(stock, field, motion, between, spare_s))
    return Removal.joined([part for part, _ in parts]), Contacts.joined([near for _, near in parts])


def pieces(
    stock: Stock,
    field: DepthField,
    motion: CutterMotion,
    between: tuple[float, float] = ALWAYS,
    spare_s: float = 0.0,
) -> Iterator[tuple[Removal, Contacts]]:
    """The same, some passes after the other."""
    left = stock.copy()
    wide = between[0] - spare_s, between[1] + spare_s
    passes = Reach(field, motion, left, wide).passes()
    for first in range(0, len(passes), PASSES):
        reach = Reach(field, motion, left, wide)
        ray, index = reach.pairs(passes[first : first + PASSES])
        high = left.end[ray]
        parts = batches(np.arange(len(ray) + 1))
        ends = in_parallel(
            lambda part: cut_at(field, left, (ray[part], index[part]), high[part]),  # noqa: B023 - run at once
            parts,
        )
        near = Contacts.near(field, ray, index, high, Ends.joined(ends))
        part = _taken(field, motion, left, near, near.index).in_time(between)
        yield part, near
        left = part.taken_from(left)


def looked_for_again(
    stock: Stock,
    known: Contacts,
    field: DepthField,
    motion: CutterMotion,
    between: tuple[float, float] = ALWAYS,
) -> tuple[Removal, Contacts] | None:
    """The same as `looked_for` on a motion within CLOSE_BY of the one that contacts were looked for on; None
    where it has not the passes of those that are `known`."""
    index = known.passes_of(field)
    if index is None:
        return None
    high = np.minimum(known.high + CLOSE_BY, stock.end[known.ray])
    ends = followed(field, stock, (known.ray, index), high, known.ends)
    near = known.with_ends(ends)
    return _taken(field, motion, stock, near, index).in_time(between), near


def _taken(field: DepthField, motion: CutterMotion, rays: Stock, near: Contacts, index: Ints) -> Removal:
    """What passes, `index` (n,) of the contacts, take of rays."""
    # on each ray only what stands when its pass comes: the shortest that earlier passes have left
    order = np.lexsort((index, near.ray))
    ray, end = near.ray[order], near.ends.radius[order]
    start = _shortest_before(ray, rays.end[ray], end)
    some = np.flatnonzero(end < start - THINNEST)
    pairs = ray[some], index[order[some]]
    return _seen(field, motion, rays, pairs, (near.ends.of(order[some]), start[some]))


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
    pairs: tuple[Ints, Ints],
    stretch: tuple[Ends, Floats],
) -> Removal:
    """Pieces of rays, from their ends to where they stood, as the edges see them that take them away."""
    (ray, index), (low, start) = pairs, stretch
    end = low.radius
    high = field.evaluate(rays.points(ray, start), index, near=low.instant)
    # the edge that has left the new surface is the one that bears the force
    _, by_s, by_rho = field.cutter.profile.depth(low.s, low.rho)
    middle = 0.5 * (low.instant + high.instant)
    place, lever, speed = _edge(motion, rays.points(ray, 0.5 * (end + start)), middle)
    # the edge needs some time to cross the ray's own breadth and height as well
    ends = np.stack([low.instant, high.instant])
    ends = at_samples(motion, motion.time_s, ends.reshape(-1)).reshape(ends.shape)
    around = speed[:, 1] * place[:, 0] - speed[:, 0] * place[:, 1]
    across = np.abs(speed[:, 2]) * rays.rise[ray] + np.abs(around) * rays.turn
    half = 0.5 * across / np.maximum((speed * speed).sum(axis=1), 1e-12)
    return Removal(
        index=index,
        ray=ray,
        end_mm=end,
        volume_mm3=0.5 * (start * start - end * end) * rays.turn * rays.rise[ray],
        thickness_mm=np.maximum(by_s * (high.s - low.s) + by_rho * (high.rho - low.rho), THINNEST),
        time_s=np.column_stack([ends.min(axis=0) - half, ends.max(axis=0) + half]),
        place_mm=place,
        lever_mm=lever,
        speed=speed,
        push=np.column_stack([by_s, by_rho]),
    )


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
