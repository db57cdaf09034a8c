"""Patches of a chart's shell, and the boxes around them."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.cutting.regular.chart import Chart

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

SAMPLED = 9
"""Rays of a block at which the way behind it is looked at."""


@dataclass(frozen=True, slots=True)
class Patches:
    """Patches of the shell: rows and columns of nodes, both ends included."""

    gap: Ints
    """(n,)"""
    i: Ints
    """(n, 2) first and last ray"""
    k: Ints
    """(n, 2) first and last section"""

    def of(self, rows: Ints) -> "Patches":
        """Some of them."""
        return Patches(self.gap[rows], self.i[rows], self.k[rows])


@dataclass(frozen=True, slots=True)
class Blocks:
    """Boxes around patches, and the rays behind them."""

    middle: Floats
    """(n, 3)"""
    corners: Floats
    """(n, 8, 3)"""
    radius: Floats
    """(n,) of the corners about the middle"""
    face: Floats
    """(c, 3, n) from the middle to points of the shell's back"""
    behind: Floats
    """(c, 3, n) ways from there to the ends of the rays"""
    slack: Floats
    """(2, n) by which points between those, and ends of ways, may stand off their chords [mm]"""
    depth: Floats
    """(n,) longest of the ways [mm]"""

    def of(self, part: slice) -> "Blocks":
        """Some of them."""
        return Blocks(
            self.middle[part],
            self.corners[part],
            self.radius[part],
            *(values[..., part] for values in (self.face, self.behind, self.slack, self.depth)),
        )

    def spokes(self, origin: Floats) -> Floats:
        """(8, 3, n) from `origin` (n, 3) to the corners."""
        return np.ascontiguousarray((self.corners - origin[:, None]).transpose(1, 2, 0))

    def outside(self, middle: Floats, radius: Floats) -> Bools:
        """Which of them stand out of balls."""
        return np.linalg.norm(self.corners - middle[:, None], axis=2).max(axis=1) > radius


def patches(cells: int, gap: Ints, k: Ints, size: tuple[int, int]) -> Patches:
    """Stretches of gaps, `cells` across and from node k (n, 2) to node, in patches of about `size` cells."""
    whole = Patches(gap, np.tile([0, cells], (len(gap), 1)), k)
    rows, columns = (
        max(math.ceil(int(np.ptp(edges, axis=1).max()) / n), 1)
        for edges, n in zip((whole.i, whole.k), size, strict=True)
    )
    parts = []
    for a in range(rows):
        i = np.minimum(whole.i[:, :1] + [a * size[0], (a + 1) * size[0]], whole.i[:, 1:])
        for b in range(columns):
            along = np.minimum(k[:, :1] + [b * size[1], (b + 1) * size[1]], k[:, 1:])
            some = along[:, 1] > along[:, 0]
            parts.append(Patches(gap[some], i[some], along[some]))
    return Patches(*(np.concatenate([getattr(p, name) for p in parts]) for name in Patches.__slots__))


def quarters(patch: Patches, size: tuple[int, int]) -> tuple[Patches, Ints]:
    """The patches halved into such of at most `size` cells, and the parent of each."""
    parts, parents = [], []
    rows = np.arange(len(patch.gap))
    for a in (0, 1):
        for b in (0, 1):
            i0 = patch.i[:, 0] + a * size[0]
            k0 = patch.k[:, 0] + b * size[1]
            i1 = np.minimum(i0 + size[0], patch.i[:, 1])
            k1 = np.minimum(k0 + size[1], patch.k[:, 1])
            some = np.flatnonzero((i0 < patch.i[:, 1]) & (k0 < patch.k[:, 1]))
            parts.append(Patches(patch.gap[some], np.stack([i0, i1], 1)[some], np.stack([k0, k1], 1)[some]))
            parents.append(rows[some])
    whole = Patches(*(np.concatenate([getattr(p, name) for p in parts]) for name in Patches.__slots__))
    parent = np.concatenate(parents)
    order = np.argsort(parent, kind="stable")
    return whole.of(order), parent[order]


def blocks(chart: Chart, patch: Patches, thick: float) -> Blocks:
    """Boxes that hold the shell on patches."""
    cells = int((patch.i[:, 1] - patch.i[:, 0]).max())
    i = np.minimum(patch.i[:, :1] + np.arange(cells + 1), patch.i[:, 1:])
    shape = (len(patch.gap), 2, cells + 1)
    gap, i, k = patch.gap[:, None, None], i[:, None, :], patch.k[:, :, None]
    point, along = chart.at(
        np.broadcast_to(gap, shape), np.broadcast_to(i, shape), np.broadcast_to(k, shape), np.zeros(1)
    )
    # axes along the gap, across it, and into the tooth
    up = (point[:, 1] - point[:, 0]).mean(axis=1)
    up /= np.linalg.norm(up, axis=1, keepdims=True)
    across = (point[:, :, -1] - point[:, :, 0]).mean(axis=1)
    across -= np.einsum("nx,nx->n", across, up)[:, None] * up
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    axes = np.stack([up, across, np.cross(up, across)], axis=1)
    both = np.stack([point - thick * along, point + thick * along], axis=1).reshape(len(point), -1, 3)
    local = np.einsum("nax,npx->npa", axes, both)
    # between its ends a twisted gap leaves the chord
    reach = np.hypot(both[..., 0], both[..., 1]).max()
    turn = abs(chart.frame.indexing.twist) * (chart.z[patch.k[:, 1]] - chart.z[patch.k[:, 0]])
    bow = reach * turn**2 / 8.0
    low, high = local.min(axis=1) - bow[:, None], local.max(axis=1) + bow[:, None]
    half = 0.5 * (high - low)
    middle = np.einsum("nax,na->nx", axes, 0.5 * (low + high))
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=np.float64)
    corners = middle[:, None] + np.einsum("na,ca,nax->ncx", half, signs, axes)
    at = np.rint(np.linspace(0, cells, min(SAMPLED, cells + 1))).astype(int)
    back = point + thick * along
    way = along * (chart.outer[i] - thick)[..., None]
    slack = np.stack([_off_chords(back, at), _off_chords(back + way, at)]) + bow
    face = back[:, :, at].reshape(len(point), -1, 3) - middle[:, None]
    behind = way[:, :, at].reshape(len(point), -1, 3)
    return Blocks(
        middle,
        corners,
        np.linalg.norm(half, axis=1),
        np.ascontiguousarray(face.transpose(1, 2, 0)),
        np.ascontiguousarray(behind.transpose(1, 2, 0)),
        slack,
        (chart.outer[i] - thick).max(axis=(1, 2)),
    )


def _off_chords(values: Floats, at: Ints) -> Floats:
    """(n,) how far values (n, 2, c, 3) stand off the chords between the columns `at`, at most."""
    n = values.shape[2]
    place = np.arange(n)
    low = np.clip(np.searchsorted(at, place, side="right") - 1, 0, len(at) - 2)
    part = ((place - at[low]) / (at[low + 1] - at[low]))[:, None]
    chord = (1.0 - part) * values[:, :, at[low]] + part * values[:, :, at[low + 1]]
    return np.linalg.norm(values - chord, axis=3).max(axis=(1, 2))


def columns(block: Blocks) -> tuple[Floats, Floats]:
    """Middles (n, 3) and radii (n,) of balls that hold the blocks and all that lies behind them."""
    ends = (block.face + block.behind).transpose(2, 0, 1)
    points = np.concatenate([block.corners - block.middle[:, None], ends], axis=1)
    middle = 0.5 * (points.min(axis=1) + points.max(axis=1))
    radius = np.linalg.norm(points - middle[:, None], axis=2).max(axis=1) + block.slack[1]
    return block.middle + middle, radius
