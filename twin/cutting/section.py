"""A blank with a transverse section of its own, the same at every height but for its turn: a pre-cut gear."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

BEYOND = 1.0
"""[mm] that its solid goes on beyond the blank's ends"""
CHORD = 1e-4
"""[mm] that facets may lie inside its helices"""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Section:
    """What a blank may fill at most, besides its turned outline."""

    outline: Floats
    """(n, 2) corners at height 0 [mm], counter-clockwise about the axis, each direction met once"""
    twist: float
    """turn of the section per height [rad/mm], + right-hand"""

    def __post_init__(self) -> None:
        """Raise ValueError for an outline that does not go around the axis once."""
        steps = np.diff(np.unwrap(np.arctan2(self.outline[:, 1], self.outline[:, 0])))
        if len(self.outline) < 3 or not (steps > 0).all() or steps.sum() >= 2.0 * math.pi:
            raise ValueError("a section's outline goes around the axis once, counter-clockwise")

    def contains(self, points: Floats) -> NDArray[np.bool_]:
        """Whether points (n, 3) lie strictly inside, at whatever height."""
        return self.beyond(points)[0] < 0.0

    def beyond(self, points: Floats) -> tuple[Floats, Floats]:
        """How far (n,) points (n, 3) lie beyond the line of the outline's side in their direction, negative
        inside [mm], and the gradient (n, 3) of that."""
        x, y = self.outline.T
        start = np.arctan2(y[0], x[0])
        turned = self.twist * points[:, 2]
        angle = (np.arctan2(points[:, 1], points[:, 0]) - turned - start) % (2.0 * math.pi)
        around = (np.arctan2(y, x) - start) % (2.0 * math.pi)
        k = np.searchsorted(around, angle, side="right") - 1
        ahead = (k + 1) % len(x)
        here = np.hypot(points[:, 0], points[:, 1])[:, None] * np.stack(
            [np.cos(angle + start), np.sin(angle + start)], axis=1
        )
        way, off = self.outline[ahead] - self.outline[k], here - self.outline[k]
        out = np.stack([way[:, 1], -way[:, 0]], axis=1) / np.linalg.norm(way, axis=1)[:, None]
        cos, sin = np.cos(turned), np.sin(turned)
        across, along = cos * out[:, 0] - sin * out[:, 1], sin * out[:, 0] + cos * out[:, 1]
        # a step up turns the section on under the point
        rise = self.twist * (across * points[:, 1] - along * points[:, 0])
        return (out * off).sum(axis=1), np.stack([across, along, rise], axis=1)

    def reach(self, at: Floats) -> Floats:
        """Radius (n,) of the outline in the directions of places (n, 3): radius, angle [rad], z."""
        ray = np.stack([np.cos(at[:, 1]), np.sin(at[:, 1]), at[:, 2]], axis=1)
        # along a ray from the axis the distance from a side's line grows evenly
        beyond, slope = self.beyond(ray)
        return 1.0 - beyond / np.einsum("nx,nx->n", slope[:, :2], ray[:, :2])

    def gaps(self, radius: float) -> Floats:
        """(m, 2) stretches of a circle at height 0 that lie outside, from and to [rad]; 0 <= from < 2π."""
        start = self.outline
        way = np.roll(start, -1, axis=0) - start
        # |start + t way|² = radius²
        a, b, c = (np.einsum("nx,nx->n", p, q) for p, q in ((way, way), (start, way), (start, start)))
        root = b * b - a * (c - radius * radius)
        root = np.sqrt(np.maximum(root, 0.0)) * np.where(root > 0.0, 1.0, np.nan)
        ends: list[Floats] = []
        for sign in (-1.0, 1.0):  # into the circle, where a gap begins, and out of it
            t = (-b + sign * root) / a
            edge = np.flatnonzero((t >= 0.0) & (t < 1.0))
            x, y = (start[edge] + t[edge, None] * way[edge]).T
            ends.append(np.sort(np.arctan2(y, x) % (2.0 * math.pi)))
        begin, end = ends
        if not len(begin):
            whole = np.array([[0.0, 2.0 * math.pi]])
            return whole if c.max() <= radius * radius else whole[:0]
        after = np.searchsorted(end, begin)
        end = np.concatenate([end, end[:1] + 2.0 * math.pi])[after]
        return np.column_stack([begin, end])

    def mesh(self, z_low: float, z_high: float) -> tuple[Floats, Ints]:
        """Closed mesh of its prism from BEYOND under `z_low` to BEYOND over `z_high`."""
        low, high = z_low - BEYOND, z_high + BEYOND
        reach = float(np.hypot(*self.outline.T).max())
        step = math.sqrt(8.0 * CHORD / reach) / abs(self.twist) if self.twist else math.inf
        layers = np.linspace(low, high, max(math.ceil((high - low) / step), 1) + 1)
        turn = np.exp(1j * self.twist * layers)[:, None] * (self.outline @ [1.0, 1j])
        n, last = len(self.outline), len(layers) - 1
        heights = np.repeat(layers, n)
        vertices = np.column_stack([turn.real.ravel(), turn.imag.ravel(), heights])
        vertices = np.vstack([vertices, [[0.0, 0.0, low], [0.0, 0.0, high]]])
        i = np.arange(n)
        j = (i + 1) % n
        base = n * np.arange(last)[:, None]
        a, b, c, d = (side.ravel() for side in (base + i, base + j, base + n + j, base + n + i))
        bottom, top = np.full(n, n * (last + 1)), np.full(n, n * (last + 1) + 1)
        faces = np.concatenate(
            [
                np.stack([a, b, c], axis=1),
                np.stack([a, c, d], axis=1),
                np.stack([j, i, bottom], axis=1),
                np.stack([n * last + i, n * last + j, top], axis=1),
            ]
        )
        return vertices, faces
