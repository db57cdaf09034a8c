"""A polygon from its mesh: faces, widths, corners, bow and twist (inspection.md, section 2).

Every face is read in several sections, each turned back by the twist found, as x over y: x along the face's
outward direction, y along the face. Three widths across flats are told apart, because polygon turning bows
its faces: at mid-face (S = 2(A - R) of geometry.md, section 3), between plain least-squares planes (about two
thirds of the bow less on a convex part), and as the parallel jaws of a caliper read it (the middles of convex
faces, the edges of concave ones).
"""

import math
from dataclasses import replace

import numpy as np
from numpy.polynomial import Legendre

from twin.errors import PartError
from twin.inspection.facets import chord_depth_um
from twin.inspection.hull import hull
from twin.inspection.nominal import PolygonNominal
from twin.inspection.recognise import Outline
from twin.inspection.result import Face, PolygonResult
from twin.inspection.sections import Segments, outer_outlines, plane_segments_in_parts
from twin.inspection.sections import outline as chained_outline
from twin.inspection.solid import Floats, Ints, Solid
from twin.inspection.tolerances import flatness_limits_um
from twin.inspection.turning import Complexes

PLANES = 21
"""sections read over the length"""
END = 0.05
"""part of the length left out at each end, where parts are chamfered"""
POINTS = 201
"""points read over the width of a face"""
EDGE = 0.05
"""part of the half width left out at each edge of a face, where a mesh rounds the corner; the fit spans it"""
MIDDLE = 0.05
"""part of the half width, to both sides, that is the middle of a face"""
TWIST_PLANES = 97
"""sections whose turn gives the twist"""
DEGREE = 6
"""of the polynomial through a face"""
ROCK = math.radians(5.0)
"""how far a caliper's jaws may stand from a face's direction"""
IRREGULAR = 0.2
"""spread of the faces' distances, as part of their mean, from which there is no regular polygon"""
LOBED = 0.6
"""bow, as part of that of a round bar, from which a face is no face"""
HOLLOW = 0.25
"""flatness, as part of a face's width, beyond which it is no face: a scoop of Q/P = -3 takes 0.08"""
GAUSS = np.polynomial.legendre.leggauss(4)
"""nodes and weights along a chord"""
UNTWISTED = 1e-3
"""a twist below this [degrees/mm] has no hand"""
NO_TWIST = 5e-5
"""a twist below this [degrees/mm] is the noise of the figures: none"""
NO_BOW = 5e-3
"""a bow below this [µm] is the noise of the figures: none"""


def measure_polygon(
    solid: Solid, outline: Outline, nominal: PolygonNominal | None
) -> tuple[PolygonResult, dict[str, str]]:
    """Measure a polygon.

    Returns:
        the result, and for every result key that cannot be measured the reason.

    Raises:
        PartError: lobes instead of faces, faces at too different distances, or not about the axis.

    """
    outline = _turn(solid, outline)
    sides = outline.count
    heights = outline.low + (outline.high - outline.low) * np.linspace(END, 1 - END, PLANES)
    grain = outline.tip_radius * math.pi / sides / POINTS
    sections = [
        _subdivided(chained_outline(outer, plane), grain)
        for outer in map(outer_outlines, plane_segments_in_parts(solid, heights))
        for plane in range(len(outer.heights))
    ]
    directions = _directions(outline, heights)
    faces = tuple(_face(outline, heights, sections, directions[:, k]) for k in range(sides))
    corner_radii = np.array([_corner_radii(p, d) for p, d in zip(sections, directions, strict=True)])
    across_corners = (corner_radii + np.roll(corner_radii, sides // 2, axis=1)).mean(axis=0)
    unmeasured = {}
    least = largest = None
    if sides % 2 == 0:
        readings = [_caliper(p, d[: sides // 2]) for p, d in zip(sections, directions, strict=True)]
        least, largest = float(np.min(readings)), float(np.max(readings))
    else:
        unmeasured["across_flats_caliper_mm"] = f"with {sides} sides no face stands opposite another"
    found = np.array([f.direction_deg for f in faces])
    mid = np.array([f.mid_distance_mm for f in faces])
    bow = _unless_noise(float(np.mean([f.bow_um for f in faces])), NO_BOW)
    if bow / 1000 > LOBED * _arc_height(float(mid.mean()), float(np.mean([f.width_mm for f in faces]))):
        raise PartError(f"{sides} lobes stand about the axis, rounder than any turned face: no polygon")
    if np.ptp(mid) > IRREGULAR * mid.mean():
        raise PartError(
            f"{sides} faces stand about the axis, but {mid.min():.3f} to {mid.max():.3f} mm from it: "
            "no regular polygon"
        )
    worst = max(faces, key=lambda f: f.flatness_um / f.width_mm)
    if worst.flatness_um / 1000 > HOLLOW * worst.width_mm:
        raise PartError(
            f"{sides} shapes of {worst.width_mm:.3f} mm stand about the axis, "
            f"{worst.flatness_um / 1000:.3f} mm from flat: lugs or gaps, no faces of a polygon"
        )
    twist = _unless_noise(math.degrees(outline.twist), NO_TWIST)
    flatness = max(f.flatness_um for f in faces)
    limits = flatness_limits_um(max(outline.high - outline.low, *(f.width_mm for f in faces)))
    result = PolygonResult(
        number_of_sides=sides,
        across_flats_mm=2 * float(mid.mean()),
        across_flats_planes_mm=2 * float(np.mean([f.distance_mm for f in faces])),
        across_flats_caliper_mm=largest,
        across_flats_caliper_least_mm=least,
        across_corners_mm=float(across_corners.mean()),
        across_corners_least_mm=float(across_corners.min()),
        bow_um=bow,
        flatness_um=flatness,
        twist_deg_per_mm=twist,
        hand="none" if abs(twist) < UNTWISTED else "right" if twist > 0 else "left",
        concentricity_um=2000 * _off_axis(np.radians(found), mid),
        angles_deg=np.mod(np.roll(found, -1) - found, 360.0),
        faces=faces,
        range_mm=(outline.low, outline.high),
        section=sections[PLANES // 2],
        reference=nominal,
        flatness_limits_um=limits,
        flatness_class=next((a for a, limit in limits.items() if flatness <= limit), "worse"),
    )
    depth = chord_depth_um(solid, result)
    widths = ("across_flats_mm", "across_flats_planes_mm", "across_flats_caliper_mm")
    uncertainty = dict.fromkeys(("bow_um", "flatness_um"), depth) | dict.fromkeys(widths, 2 * depth / 1000)
    return replace(result, uncertainty=uncertainty), unmeasured


def _short_chords(outer: Segments, sides: int) -> tuple[Complexes, Complexes, Ints]:
    """Cut each chord so that a side has at least 16 of them: starts, ends (n,), and the chord of each."""
    start, end = (p[:, 0] + 1j * p[:, 1] for p in (outer.start, outer.end))
    parts = np.maximum(np.ceil(np.abs(np.angle(end * start.conj())) * sides * 8 / math.pi), 1).astype(
        np.int64
    )
    row = np.repeat(np.arange(len(parts)), parts)
    at = (np.arange(len(row)) - np.repeat(np.cumsum(parts) - parts, parts)) / parts[row]
    step = (end - start)[row]
    return start[row] + at * step, start[row] + (at + 1 / parts[row]) * step, row


def _turn(solid: Solid, outline: Outline) -> Outline:
    """Return the outline with its twist and phase by the turn of whole sections, over the whole length.

    A section's turn is the phase of the harmonic of as many waves as there are sides. Single faces would not
    do: where a straight insert cuts a twisted face, that face is a flight of stairs, one step each work turn.
    """
    heights = outline.low + (outline.high - outline.low) * (np.arange(TWIST_PLANES) + 0.5) / TWIST_PLANES
    wave = np.zeros(TWIST_PLANES, dtype=np.complex128)
    done = 0
    for outer in map(outer_outlines, plane_segments_in_parts(solid, heights)):
        start, end, row = _short_chords(outer, outline.count)
        # r² d(angle) is the same all along a chord; the wave over it by Gauss and Legendre
        sector = (start.conj() * end).imag
        over = np.zeros(len(row), dtype=np.complex128)
        for node, share in zip(*GAUSS, strict=True):
            at = start + (node + 1) / 2 * (end - start)
            over += share / 2 * (at.conj() / np.abs(at)) ** outline.count
        np.add.at(wave, done + outer.plane[row], sector * over)
        done += len(outer.heights)
    along = heights - outline.middle
    rest = wave * np.exp(1j * outline.count * (outline.phase + outline.twist * along))
    slope, offset = np.polyfit(along, -np.unwrap(np.angle(rest)) / outline.count, 1)
    return replace(outline, twist=outline.twist + float(slope), phase=outline.phase + float(offset))


def _unless_noise(value: float, noise: float) -> float:
    return 0.0 if abs(value) < noise else value


def _subdivided(points: Floats, grain: float) -> Floats:
    """Return a closed outline (n, 2) with points along its chords, at most `grain` [mm] apart."""
    chord = np.roll(points, -1, axis=0) - points
    pieces = np.maximum(np.ceil(np.hypot(*chord.T) / grain).astype(np.int64), 1)
    row = np.repeat(np.arange(len(points)), pieces)
    part = (np.arange(len(row)) - np.repeat(np.cumsum(pieces) - pieces, pieces)) / pieces[row]
    return points[row] + part[:, None] * chord[row]


def _directions(outline: Outline, heights: Floats) -> Floats:
    """Return the faces' outward directions [rad], (planes, sides), from the face nearest C0 on."""
    pitch = 2 * math.pi / outline.count
    first = outline.phase + pitch / 2
    first -= pitch * round(first / pitch)
    turn = outline.twist * (heights - outline.middle)
    return first + turn[:, None] + pitch * np.arange(outline.count)


def _face(outline: Outline, heights: Floats, sections: list[Floats], direction: Floats) -> Face:
    """Fit one face over all sections: a polynomial across, a tilt and the remaining twist along."""
    pitch = 2 * math.pi / outline.count
    views = [_view(p, d, pitch) for p, d in zip(sections, direction, strict=True)]
    ends = np.median([_edges(v, 0.01 * outline.depth) for v in views], axis=0)
    y = (1 - EDGE) * np.linspace(ends[0, 0], ends[1, 0], POINTS)
    x = np.array([np.interp(y, v[:, 1], v[:, 0]) for v in views])
    width = float(np.abs(ends[:, 0]).max())
    level = np.polynomial.legendre.legvander(y / width, DEGREE)
    along, across = np.broadcast_arrays((heights - outline.middle)[:, None], y)
    columns = [np.broadcast_to(c, x.shape).ravel() for c in level.T]
    design = np.column_stack([*columns, along.ravel(), (along * across).ravel()])
    solution = np.linalg.lstsq(design, x.ravel(), rcond=None)[0]
    profile = Legendre(solution[: DEGREE + 1], domain=[-width, width])
    tilt, rest_of_twist = solution[DEGREE + 1 :]
    left, right = (_meet(profile, math.copysign(pitch / 2, y_end), r_end, outline) for y_end, r_end in ends)
    whole = np.linspace(left, right, POINTS)
    slope, distance = np.polyfit(whole, profile(whole), 1)
    # a face of several cuts is not as smooth as the polynomial
    missed = x.ravel() - design @ solution
    middle = float(profile(0.0) + missed.reshape(x.shape)[:, np.abs(y) <= MIDDLE * width].mean())
    flat = distance + slope * across + tilt * along + rest_of_twist * along * across
    rest = np.concatenate([(x - flat).ravel(), profile(whole) - distance - slope * whole])
    at_left, at_right = profile(left), profile(right)
    chord = (at_left * right - at_right * left) / (right - left)
    return Face(
        direction_deg=math.degrees(np.interp(outline.middle, heights, direction) - math.atan(slope)),
        distance_mm=float(distance * math.cos(math.atan(slope))),
        width_mm=right - left,
        mid_distance_mm=middle,
        bow_um=_unless_noise(1000 * float(middle - chord), NO_BOW),
        flatness_um=1000 * float(np.ptp(rest)),
        twist_deg_per_mm=_unless_noise(math.degrees(outline.twist - rest_of_twist), NO_TWIST),
    )


def _view(points: Floats, direction: float, pitch: float) -> Floats:
    """Return the part (n, 2) of an outline that faces `direction`, turned so that this is x, by rising y."""
    cos, sin = math.cos(direction), math.sin(direction)
    turned = points @ np.array([[cos, -sin], [sin, cos]])
    near = np.abs(np.arctan2(turned[:, 1], turned[:, 0])) <= 0.5 * pitch
    return turned[near][np.argsort(turned[near, 1])]


def _edges(view: Floats, margin: float) -> Floats:
    """Return y and radius of a face's two ends, ((y, r), (y, r)): where its radius stops growing."""
    radius = np.hypot(*view.T)
    ends = []
    for sign in (-1, 1):
        side = sign * view[:, 1] >= 0
        if not side.any():
            raise PartError("the outline does not go round the axis at every height: no polygon")
        y, r = view[side, 1][::sign], radius[side][::sign]
        beyond = int(np.argmax(r >= r.max() - margin))
        ends.append((y[beyond], r.max()))
    return np.array(ends)


def _meet(profile: Legendre, half_pitch: float, radius: float, outline: Outline) -> float:
    """Return y where a face ends: at its neighbour, or before it at the blank's own circle."""
    reach = 1.2 * float(profile.domain[1])  # the fit says nothing far beyond the points it is made of
    y = 0.0
    for _ in range(20):
        y = float(np.clip(math.tan(half_pitch) * profile(y), -reach, reach))
    if math.hypot(y, float(profile(y))) <= radius + 0.02 * outline.depth:
        return y
    for _ in range(20):
        y = math.copysign(math.sqrt(max(radius**2 - float(profile(y)) ** 2, 0.0)), half_pitch)
    return y


def _corner_radii(points: Floats, directions: Floats) -> Floats:
    """Return the largest radius (sides,) between each face and the next [mm]."""
    pitch = 2 * math.pi / len(directions)
    angle = np.arctan2(points[:, 1], points[:, 0]) - directions[0]
    largest = np.zeros(len(directions))
    np.maximum.at(largest, np.floor(angle / pitch).astype(np.int64) % len(directions), np.hypot(*points.T))
    return largest


def _caliper(points: Floats, directions: Floats) -> list[float]:
    """Return the least width [mm] parallel jaws read near each direction: one lies on an edge of the hull."""
    corners = points[hull(points)]
    edge = np.roll(corners, -1, axis=0) - corners
    normal = np.column_stack([edge[:, 1], -edge[:, 0]]) / np.hypot(*edge.T)[:, None]
    angle = np.arctan2(normal[:, 1], normal[:, 0])
    order = np.argsort(angle)
    # the other jaw touches the corner between the edges that face it
    behind = np.searchsorted(angle[order], np.where(angle > 0, angle - math.pi, angle + math.pi))
    other = corners[order[behind % len(order)]]
    widths = np.einsum("ij,ij->i", normal, corners - other)
    readings = []
    for direction in directions:
        # either jaw may be the one that lies flat
        away = np.abs(np.mod(angle - direction + math.pi / 2, math.pi) - math.pi / 2)
        readings.append(float(widths[away <= max(ROCK, float(away.min()))].min()))
    return readings


def _arc_height(radius: float, width: float) -> float:
    """Return how high a circle rises over a chord [mm]."""
    return radius * (1 - math.cos(math.asin(min(width / 2 / radius, 1.0))))


def _off_axis(directions: Floats, distances: Floats) -> float:
    """Return how far from the work axis [mm] the middle of all faces lies."""
    design = np.column_stack([np.ones_like(directions), np.cos(directions), np.sin(directions)])
    return float(np.hypot(*np.linalg.lstsq(design, distances, rcond=None)[0][1:]))
