"""The cutting edge as a line, and places along it.

Each piece of a tooth, and the land between the teeth, has its own line: its sides and arcs one after
the other, from the side of negative s over the tip to the other.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutters.convex import ConvexPiece, Round, Side
from twin.cutters.hollow import HollowPiece, Straight
from twin.cutters.pieces import Piece
from twin.cutters.profile import ToothProfile

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

ON = 1e-12
"""[mm] that a place on the outline may seem to be off it"""
SHORTEST = 1e-5
"""[mm] of a stretch: a line that only touches an arc is none"""
HALVINGS = 45
TABLE = 1 << 13
"""places of a line at which is asked whether it cuts"""


@dataclass(frozen=True, slots=True)
class EdgeLine:
    """Straight and round stretches of an outline, one after the other."""

    begin: Floats
    """(n + 1,) where each stretch begins on the line, and where the last ends [mm]"""
    centre: Floats
    """(n, 2) (s, rho) of arcs, or where a straight stretch begins [mm]"""
    radius: Floats
    """(n,) of arcs, − of hollow ones; 0 = straight [mm]"""
    angle: Floats
    """(n,) of the outward normal where the stretch begins [rad]; it falls along arcs and rises along hollow
    ones"""
    real: NDArray[np.bool_]
    """(TABLE,) whether it cuts, at even distances: not inside of another piece, nor of the land"""

    @property
    def length(self) -> float:
        """Of the whole line [mm]."""
        return float(self.begin[-1])

    def at(self, along: Floats, above: float = 0.0) -> Floats:
        """Places (n, 2) of the rake plane on the line, or some way above it, inside the tooth [mm]."""
        k = np.clip(np.searchsorted(self.begin, along, side="right") - 1, 0, len(self.radius) - 1)
        off, radius = along - self.begin[k], self.radius[k]
        straight = radius == 0.0
        angle = self.angle[k] - np.where(straight, 0.0, off / np.where(straight, 1.0, radius))
        sin, cos, way = np.sin(angle), np.cos(angle), np.where(straight, off, 0.0)
        out = radius - above
        return self.centre[k] + np.column_stack([out * cos + way * sin, out * sin - way * cos])

    def cuts(self, along: Floats) -> NDArray[np.bool_]:
        """Whether (n,) the line is an edge there."""
        number = np.floor(along * (TABLE / self.length)).astype(np.int64)
        return self.real[np.clip(number, 0, TABLE - 1)]

    def nearest(self, place: Floats) -> Floats:
        """Where (n,) on the line places (n, 2) of the rake plane have their nearest one."""
        best, along = np.full(len(place), np.inf), np.zeros(len(place))
        for k, (begin, end) in enumerate(zip(self.begin[:-1], self.begin[1:], strict=True)):
            off = place - self.centre[k]
            if self.radius[k]:
                outward = np.arctan2(*(math.copysign(1.0, self.radius[k]) * off.T[::-1]))
                angle = (self.angle[k] - outward + np.pi) % (2.0 * np.pi) - np.pi
                way = angle * self.radius[k]
            else:
                way = off @ [math.sin(self.angle[k]), -math.cos(self.angle[k])]
            here = begin + np.clip(way, 0.0, end - begin)
            away = np.linalg.norm(self.at(here) - place, axis=1)
            nearer = away < best
            best[nearer], along[nearer] = away[nearer], here[nearer]
        return along


def edge_lines(profile: ToothProfile, teeth: tuple[float, float]) -> tuple[EdgeLine, ...]:
    """The lines of a tooth's pieces about s = 0 and, where there is one, of the land between `teeth` (s)."""
    lines: list[EdgeLine] = []
    far = 2.0 * (abs(profile.tip) + profile.half_width)
    lines += [_line(profile, _stretches(piece, far)) for piece in profile.pieces]
    if math.isfinite(profile.root):
        low, high = teeth
        land = (np.array([low, profile.root]), 0.0, 0.5 * math.pi, high - low)
        lines.append(_line(profile, [land]))
    return tuple(lines)


_Stretch = tuple[Floats, float, float, float]
"""Centre or begin, radius, angle of the normal there, length"""


def _stretches(piece: Piece, far: float) -> list[_Stretch]:
    """The whole outline of a piece, as far as it is above the tool's axis, and within `far` [mm]."""
    if isinstance(piece, HollowPiece):
        right = [s for part in piece.parts for s in _as_drawn(part, far)]
        return [_image(s) for s in right[::-1]] + right
    # the tangents at the ends of arcs can be sides once more
    sides = {(*np.round(side.normal, 9), round(side.height, 9)): side for side in piece.sides}.values()
    found = [s for side in sides for s in _straight(piece, side, far)]
    found += [s for arc in piece.rounds for s in _round(piece, arc)]
    # convex: one after the other by their normals
    return sorted(found, key=lambda s: -((s[2] + 0.5 * math.pi) % (2.0 * math.pi)))


def _as_drawn(part: Straight | Round, far: float) -> list[_Stretch]:
    """A part of an outline that has been drawn from end to end."""
    if isinstance(part, Straight):
        angle = math.atan2(part.normal[1], part.normal[0])
        axis = part.start[1] / part.normal[0] if part.normal[0] > 0 else math.inf
        centre, radius, length = np.array(part.start), 0.0, min(part.length, axis, far)
    else:
        angle, last = (math.atan2(n[1], n[0]) for n in (part.first, part.last))
        centre, radius, length = np.array(part.centre), part.radius, part.radius * (angle - last)
    return [(centre, radius, angle, length)] if length > SHORTEST else []


def _image(stretch: _Stretch) -> _Stretch:
    """A stretch on the tooth's other half, where it is met from its other end."""
    centre, radius, angle, length = stretch
    if radius:
        angle -= length / radius
    else:
        centre = centre + length * np.array([math.sin(angle), -math.cos(angle)])
    return centre * [-1.0, 1.0], radius, math.pi - angle, length


def _line(profile: ToothProfile, found: list[_Stretch]) -> EdgeLine:
    begin = np.concatenate([[0.0], np.cumsum([s[3] for s in found])])
    centre = np.array([s[0] for s in found]).reshape(-1, 2)
    radius, angle = (np.array([s[k] for s in found]) for k in (1, 2))
    line = EdgeLine(begin, centre, radius, angle, np.zeros(TABLE, dtype=bool))
    place = line.at((np.arange(TABLE) + 0.5) * line.length / TABLE)
    line.real[:] = profile.depth(*place.T)[0] < ON
    return line


def _straight(piece: ConvexPiece, side: Side, far: float) -> list[_Stretch]:
    """The stretches of the outline on a side, and on its image on the tooth's other half."""
    normal = np.array(side.normal)
    way = np.array([normal[1], -normal[0]])
    middle = normal * side.height

    def on(t: float) -> float:
        s, rho = middle + t * way
        if rho < 0.0:
            return -far
        return float(piece.depth(np.array([abs(s)]), np.array([rho]))[0][0])

    ends = _where(on, -far, far)
    if ends is None:
        return []
    start, length = middle + ends[0] * way, ends[1] - ends[0]
    angle = math.atan2(normal[1], normal[0])
    if abs(normal[0]) < SHORTEST:
        return [(start, 0.0, angle, length)]
    end = start + length * way
    return [(start, 0.0, angle, length), (end * [-1.0, 1.0], 0.0, math.pi - angle, length)]


def _round(piece: ConvexPiece, arc: Round) -> list[_Stretch]:
    """An arc and its image, as far as they are on the outline."""
    first, last = (math.atan2(n[1], n[0]) for n in (arc.first, arc.last))

    def on(angle: float) -> float:
        s = arc.centre[0] + arc.radius * math.cos(angle)
        rho = arc.centre[1] + arc.radius * math.sin(angle)
        return float(piece.depth(np.array([abs(s)]), np.array([rho]))[0][0])

    ends = _where(on, last, first) if arc.radius > SHORTEST else None
    if ends is None:
        return []
    centre, length = np.array(arc.centre), arc.radius * (ends[1] - ends[0])
    image = centre * [-1.0, 1.0]
    return [(centre, arc.radius, ends[1], length), (image, arc.radius, math.pi - ends[0], length)]


def _where(depth: Callable[[float], float], low: float, high: float) -> tuple[float, float] | None:
    """From where to where a concave function, nowhere above 0, is 0; None for less than SHORTEST."""
    a, b = low, high
    for _ in range(2 * HALVINGS):
        one, two = a + (b - a) / 3.0, b - (b - a) / 3.0
        if depth(one) < depth(two):
            a = one
        else:
            b = two
    top = 0.5 * (a + b)
    if depth(top) < -ON:
        return None
    ends = [_end(depth, top, side) for side in (low, high)]
    return (ends[0], ends[1]) if ends[1] - ends[0] > SHORTEST else None


def _end(depth: Callable[[float], float], inside: float, outside: float) -> float:
    """The last place from `inside` towards `outside` that is on the outline."""
    if depth(outside) >= -ON:
        return outside
    for _ in range(HALVINGS):
        middle = 0.5 * (inside + outside)
        if depth(middle) < -ON:
            outside = middle
        else:
            inside = middle
    return inside
