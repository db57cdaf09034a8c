"""The skins of all gaps as closed tubes: shut beyond the blank's ends and outside of it."""

import numpy as np
from numpy.typing import NDArray

from twin.cutting.dual import Surface
from twin.cutting.regular.chart import Chart
from twin.cutting.regular.irregular import IrregularError
from twin.cutting.regular.skin import Skin
from twin.cutting.sheets import Sheets

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]


def tubes(chart: Chart, made: Skin) -> Surface:
    """What was removed, gap by gap. Raises IrregularError where a skin does not reach out of the blank."""
    gaps = chart.gaps
    rotation, shift = chart.mount.rotation, chart.mount.translation
    inner = made.vertices @ rotation.T + shift
    rims = inner[:, [0, -1]]
    radius = np.hypot(rims[..., 0], rims[..., 1])
    if radius.min() <= chart.frame.stock:
        raise IrregularError("the gaps end inside the blank")
    # the lid: along the gap's middle, so far out that it clears the blank
    indexing = chart.frame.indexing
    z = rims[..., 2].mean(axis=1)
    turn = indexing.phase + 2.0 * np.pi / gaps * np.arange(gaps)[:, None] + indexing.twist * z
    off = np.arctan2(rims[..., 1], rims[..., 0]) - turn[:, None]
    off = np.abs((off + np.pi) % (2.0 * np.pi) - np.pi).max(axis=1)
    height = radius.max(axis=1) / np.cos(off)
    lid = np.stack([height * np.cos(turn), height * np.sin(turn), z], axis=-1)
    ring = np.concatenate([inner, lid[:, None]], axis=1)
    # flat ends beyond both faces
    low, high = ring[:, :, :1].copy(), ring[:, :, -1:].copy()
    step = chart.z[1] - chart.z[0]
    low[..., 2] = (chart.z[0] - step + chart.lift)[:, None, None]
    high[..., 2] = (chart.z[-1] + step + chart.lift)[:, None, None]
    vertices = (np.concatenate([low, ring, high], axis=2) - shift) @ rotation
    # no bite made the lid and the ends
    beside = (0, 0), (0, 1), (1, 1)
    bite = np.pad(made.bite, beside, constant_values=-1)
    instant = np.pad(made.instant, beside, constant_values=np.nan)
    return Surface(
        vertices.reshape(-1, 3),
        _faces(made.rising),
        bite.reshape(-1),
        instant.reshape(-1),
        _sheets(made.rising),
    )


def _faces(rising: Bools) -> Ints:
    """Triangles of the tubes, normals outwards. The lid's vertices are the last of each ring."""
    gaps, nu, nz = rising.shape
    around, along = nu + 2, nz + 3
    number = np.arange(around * along).reshape(around, along)
    after = np.roll(number, -1, axis=0)
    a, b, c, d = number[:, :-1], after[:, :-1], after[:, 1:], number[:, 1:]
    split = np.ones((gaps, around, along - 1, 1), dtype=bool)
    split[:, :nu, 1:-1, 0] = rising
    first = np.arange(gaps)[:, None, None, None] * (around * along)
    one = np.where(split, np.stack([a, b, c], axis=-1), np.stack([a, b, d], axis=-1)) + first
    two = np.where(split, np.stack([a, c, d], axis=-1), np.stack([b, c, d], axis=-1)) + first
    cap = _ladder(around)
    ends = np.concatenate([number[cap, 0][:, ::-1], number[cap, -1]]) + first[:, 0]
    return np.concatenate([faces.reshape(-1, 3) for faces in (one, two, ends)])


def _sheets(rising: Bools) -> Sheets:
    """The skins without lids and ends, in the order of `_faces`."""
    gaps, nu, nz = rising.shape
    number = np.arange(gaps * (nu + 2) * (nz + 3)).reshape(gaps, nu + 2, nz + 3)
    cell = np.arange(gaps * (nu + 2) * (nz + 2)).reshape(gaps, nu + 2, nz + 2)
    both = np.stack([cell, cell + cell.size], axis=-1)
    return Sheets(number[:, :-1, 1:-1], both[:, :nu, 1:-1])


def _ladder(around: int) -> Ints:
    """Triangles (n, 3) of a flat end, from the one flank to the other below the lid's vertex, the last."""
    left, right = 0, around - 2
    rungs = [(around - 1, left, right)]
    while right - left > 1:
        rungs.append((left, left + 1, right))
        left += 1
        if right - left > 1:
            rungs.append((left, right - 1, right))
            right -= 1
    return np.array(rungs)
