"""A tooth as the union of overlapping pieces without hollow corners.

At a hollow corner of the outline both neighbouring strokes, drawn on, run inside the tooth. So each stretch
between two hollow corners, drawn on at both ends until it would leave the tooth, bounds a piece, and the
pieces together are the tooth. A piece without hollow arcs is convex.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from twin.cutters.chain import SAME, Stroke
from twin.cutters.convex import ConvexPiece, Point, Round, Side
from twin.cutters.hollow import HollowPiece, Straight

Piece = ConvexPiece | HollowPiece
_Path = list[tuple[Point, Side | Round]]
"""What bounds a piece from the tip down, each with the point where it begins"""

STRAIGHT = 1e-7
"""[rad] below which two strokes run on without a corner"""
LEVEL = 1e-12
"""[rad] that a vertical side may lean by rounding"""
HALVINGS = 60


def tooth_pieces(strokes: Sequence[Stroke], root: float) -> tuple[Piece, ...]:
    """Pieces of the tooth that `strokes` outline, from the tip down to its land at `root` [mm].

    Without a land (−inf) the tooth goes on straight down from the last stroke.
    """
    chain = list(strokes)
    if math.isinf(root):
        x, rho = chain[-1].end
        chain.append(Stroke(start=(x, rho), end=(x, -abs(chain[0].start[1]))))
    starts = [
        k
        for k in range(len(chain))
        if k == 0 or _angle(chain[k].first_normal) > _angle(chain[k - 1].last_normal) + STRAIGHT
    ]
    ends = [*starts[1:], len(chain)]
    return tuple(_piece(chain, a, b, root) for a, b in zip(starts, ends, strict=True))


def _angle(normal: Point) -> float:
    return math.atan2(normal[1], normal[0])


def _piece(chain: list[Stroke], first: int, end: int, root: float) -> Piece:
    """The piece that strokes `first` to `end` − 1 bound."""
    own = chain[first:end]
    top, bottom = own[0].start, own[-1].end
    upper, lower = own[0].first_normal, own[-1].last_normal
    path: _Path = []
    if upper[0] > STRAIGHT:
        drawn = _Line(top, upper)
        left = _leaves(drawn, chain[:first][::-1], upwards=True)
        top = drawn.up_to(chain[0].start[1] if left is None else left)
    if top[0] > SAME:
        path.append(((0.0, top[1]), _side((0.0, 1.0), top)))
    else:
        path.append((top, Round(centre=top, radius=0.0, first=(0.0, 1.0), last=upper)))
    path.append((top, _side(upper, top)))
    for stroke in own:
        path += _outline(stroke)
    path.append((bottom, _side(lower, bottom)))
    if lower[0] > STRAIGHT:
        drawn = _Line(bottom, lower)
        left = _leaves(drawn, chain[end:], upwards=False)
        if left is not None:
            path += _closed(chain[end:], drawn.up_to(left), lower)
    return _hollow(path, root) if any(stroke.radius < 0 for stroke in own) else _convex(path, root)


def _closed(below: list[Stroke], leaves: Point, normal: Point) -> _Path:
    """What bounds a piece from where its last side leaves the tooth: straight down as far as that can be."""
    if normal[1] <= 0:
        return [(leaves, _side((0.0, -1.0), leaves))]
    rest = [stroke for stroke in below if stroke.end[1] < leaves[1] - SAME]
    left = _leaves(_Line(leaves, (1.0, 0.0)), rest, upwards=False, begin=leaves[1])
    straight: _Path = [(leaves, _side((1.0, 0.0), leaves))]
    if left is None:
        return straight
    bottom = leaves[0], left
    return [*straight, (bottom, _side((0.0, -1.0), bottom))]


def _side(normal: Point, at: Point) -> Side:
    return Side(normal=normal, height=normal[0] * at[0] + normal[1] * at[1])


def _outline(stroke: Stroke) -> _Path:
    """A line; or an arc between its end tangents, which bound the depth deep inside."""
    first, last = stroke.first_normal, stroke.last_normal
    if not stroke.radius:
        return [(stroke.start, _side(first, stroke.start))]
    arc = Round(centre=stroke.centre, radius=stroke.radius, first=first, last=last)
    return [
        (stroke.start, _side(first, stroke.start)),
        (stroke.start, arc),
        (stroke.end, _side(last, stroke.end)),
    ]


@dataclass(frozen=True, slots=True)
class _Line:
    """A stroke drawn on: through `start`, at right angles to `normal`."""

    start: Point
    normal: Point

    def half_width(self, rho: float) -> float:
        """Its distance from the tooth's middle [mm]."""
        return self.start[0] - self.normal[1] / self.normal[0] * (rho - self.start[1])

    def up_to(self, rho: float) -> Point:
        """Its point at `rho`, or on the tooth's middle where it comes there before."""
        x = self.half_width(rho)
        if x > 0:
            return x, rho
        return 0.0, self.start[1] + self.start[0] * self.normal[0] / self.normal[1]


def _leaves(line: _Line, strokes: list[Stroke], *, upwards: bool, begin: float | None = None) -> float | None:
    """Distance from the tool axis at which a line drawn on past `strokes` leaves the tooth; None = never.

    `begin`: where on the first stroke it starts.
    """
    for number, stroke in enumerate(strokes):
        near, far = (stroke.end, stroke.start) if upwards else (stroke.start, stroke.end)
        if begin is not None and number == 0:
            near = stroke.half_width(begin), begin
        if abs(far[1] - near[1]) < SAME:
            continue
        if line.half_width(near[1]) > near[0] + SAME:
            return near[1]
        most = _farthest(line, stroke, near, far)
        if line.half_width(most[1]) > most[0] + SAME:
            return _crossing(line, stroke, near[1], most[1])
    return None


def _farthest(line: _Line, stroke: Stroke, near: Point, far: Point) -> Point:
    """Where on a stroke a line that is inside of it at its `near` end stands out the most, if it does.

    Out of what does not bulge inwards it does so at the far end.
    """
    if stroke.radius >= 0:
        return far
    along = stroke.centre[1] + stroke.radius * line.normal[1]
    if (along - near[1]) * (far[1] - near[1]) <= 0:
        return near
    if (along - far[1]) * (near[1] - far[1]) <= 0:
        return far
    return stroke.centre[0] + stroke.radius * line.normal[0], along


def _crossing(line: _Line, stroke: Stroke, near: float, far: float) -> float:
    """Where a line that is inside the tooth beside a stroke's `near` end and outside at its `far` end leaves.

    It does so once: what it stands out by is a convex function beside a bulging stroke, and a concave one
    that rises from `near` to `far` beside a hollow one.
    """
    for _ in range(HALVINGS):
        middle = 0.5 * (near + far)
        if line.half_width(middle) > stroke.half_width(middle):
            far = middle
        else:
            near = middle
    return near


def _convex(path: _Path, root: float) -> ConvexPiece:
    """A piece without hollow arcs."""
    sides: list[Side] = []
    rounds: list[Round] = []
    before: Point | None = None
    for start, part in path:
        first, last = _normals(part)
        if before is not None and _angle(before) > _angle(first) + STRAIGHT:
            rounds.append(Round(centre=start, radius=0.0, first=before, last=first))
        if isinstance(part, Side):
            if not sides or _angle(sides[-1].normal) > _angle(first) + STRAIGHT:
                sides.append(part)
        elif _angle(first) > _angle(last) + STRAIGHT:
            rounds.append(part)
        before = last
    return ConvexPiece(sides=tuple(sides), rounds=tuple(rounds), half_width=_widest(path, root))


def _hollow(path: _Path, root: float) -> HollowPiece:
    """A piece with hollow arcs."""
    parts: list[Straight | Round] = []
    before: Point | None = None
    ends = [start for start, _ in path[1:]]
    for (start, part), end in zip(path, [*ends, None], strict=True):
        first, last = _normals(part)
        long = _length(start, first) if end is None else math.hypot(end[0] - start[0], end[1] - start[1])
        if isinstance(part, Side) and end is not None and long < SAME:
            # a tangent at the end of an arc, which its neighbours stand for
            continue
        if before is not None and _angle(before) > _angle(first) + STRAIGHT:
            parts.append(Round(centre=start, radius=0.0, first=before, last=first))
        if isinstance(part, Side):
            parts.append(Straight(start=start, normal=first, length=long))
        elif abs(_angle(first) - _angle(last)) > STRAIGHT:
            parts.append(part)
        before = last
    last = parts[-1]
    if isinstance(last, Straight) and 0 > last.normal[1] > -1:
        # it comes to the middle of the tooth, and to its image
        tip = 0.0, last.start[1] - last.length * last.normal[0]
        parts.append(Round(centre=tip, radius=0.0, first=last.normal, last=(0.0, -1.0)))
    least = min(-part.radius for part in parts if isinstance(part, Round) and part.radius < 0)
    return HollowPiece(parts=tuple(parts), hollow=least, half_width=_widest(path, root))


def _length(start: Point, normal: Point) -> float:
    """Of a side that goes on from `start`, as far as the middle of the tooth [mm]."""
    return -start[0] / normal[1] if normal[1] < -LEVEL else math.inf


def _normals(part: Side | Round) -> tuple[Point, Point]:
    """Outward normals at the upper and the lower end."""
    return (part.normal, part.normal) if isinstance(part, Side) else (part.first, part.last)


def _widest(path: _Path, root: float) -> float:
    """Half the width of a piece where it is widest above the land [mm]."""
    widest = max((x for (x, rho), _ in path if rho >= root), default=0.0)
    for _, part in path:
        if isinstance(part, Round) and part.first[1] > 0 > part.last[1] and part.radius > 0:
            widest = max(widest, part.centre[0] + part.radius)
    _, last = path[-1]
    if isinstance(last, Side) and last.normal[0] > STRAIGHT:
        lowest = 0.0 if abs(last.normal[1]) < LEVEL else last.normal[1] * root
        widest = max(widest, (last.height - lowest) / last.normal[0])
    return widest
