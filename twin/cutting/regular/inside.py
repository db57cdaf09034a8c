"""Proof that everything before the shell is removed: in each block there, one bite is deep enough."""

import numpy as np
from numpy.typing import NDArray

from twin.cutting.local import Tangents
from twin.cutting.pairs import batches, in_parallel, leaders
from twin.cutting.regular.chart import Chart
from twin.cutting.regular.irregular import IrregularError
from twin.cutting.regular.patches import Patches, quarters
from twin.cutting.regular.tiles import UNCUT
from twin.cutting.sweep import Sweep

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

ROUNDS = 7
"""How often what is not proved is split, by turns along the rays and across them, before it is given up."""
NEAR = 0.25
"""Share of the rays' way on which the part nearer to the shell is split off."""
SLOPE = 1.1
"""Bound on a depth's gradient where the culling proves anything at all: the stock is slower than the edge."""

LOOKED_AT = 8
"""Gaps at most in whose middles a look is taken before anything is proved."""


def look_inside(sweep: Sweep, chart: Chart, thick: float) -> None:
    """Raise IrregularError where the middle of a gap is left standing: no proof can hold, and the look is
    soon taken."""
    nu, nz = chart.cells
    gaps = np.unique(np.linspace(0, chart.gaps - 1, LOOKED_AT).astype(np.int64))
    gap, k = np.meshgrid(gaps, [0, nz // 2, nz])
    i = np.full(gap.shape, nu // 2)
    points, _ = chart.at(gap, i, k, -0.5 * (thick + chart.inner[i]))
    if (sweep.unculled(points.reshape(-1, 3)) <= 0).any():
        raise IrregularError(UNCUT)


def prove_inside(sweep: Sweep, chart: Chart, patch: Patches, tangents: Tangents, thick: float) -> None:
    """Raise IrregularError unless all that lies before the shell on the rays of the patches is removed."""
    row = np.arange(len(patch.gap))
    share = np.tile([0.0, 1.0], (len(row), 1))
    for number in range(ROUNDS):
        held = _removed(sweep, tangents.of(row), *_hulls(chart, patch, share, thick))
        row, patch, share = row[~held], patch.of(np.flatnonzero(~held)), share[~held]
        if not len(row):
            return
        if number % 2:
            size = int(np.ptp(patch.i, axis=1).max() + 1) // 2, int(np.ptp(patch.k, axis=1).max() + 1) // 2
            patch, parent = quarters(patch, size)
            row, share = row[parent], share[parent]
        else:
            # close to the shell the bites that make the surface are deep enough only nearby
            middle = share[:, 0] + NEAR * (share[:, 1] - share[:, 0])
            share = np.concatenate([np.stack([share[:, 0], middle], 1), np.stack([middle, share[:, 1]], 1)])
            row, patch = np.tile(row, 2), patch.of(np.tile(np.arange(len(row)), 2))
    raise IrregularError("something is left standing in the gaps")


def _hulls(chart: Chart, patch: Patches, share: Floats, thick: float) -> tuple[Floats, Floats]:
    """Points (n, c, 3) whose hulls hold what lies on the rays of patches, all but what they miss (n,) [mm].

    The rays are taken between two shares (n, 2) of the way from the shell back to the gap's middle.
    """
    cells = int((patch.i[:, 1] - patch.i[:, 0]).max())
    i = np.minimum(patch.i[:, :1] + np.arange(cells + 1), patch.i[:, 1:])[:, None, None, :]
    k = patch.k[:, None, :, None]
    tau = -thick - share[:, :, None, None] * (chart.inner[i] - thick)
    gap, i, k, tau = np.broadcast_arrays(patch.gap[:, None, None, None], i, k, tau)
    points = chart.at(gap, i, k, tau)[0].reshape(len(gap), -1, 3)
    # between its ends a twisted gap leaves the chord
    turn = abs(chart.frame.indexing.twist) * (chart.z[patch.k[:, 1]] - chart.z[patch.k[:, 0]])
    return points, np.hypot(points[..., 0], points[..., 1]).max(axis=1) * turn**2 / 8.0


def _removed(sweep: Sweep, tangents: Tangents, points: Floats, bow: Floats) -> Bools:
    """Whether one bite removes the hull of each group of points (n, c, 3), and `bow` (n,) around it."""
    middle = 0.5 * (points.min(axis=1) + points.max(axis=1))
    radius = np.linalg.norm(points - middle[:, None], axis=2).max(axis=1)
    owner = tangents.lists.owner()
    height = tangents.plane[0] + np.einsum("xm,mx->m", tangents.plane[1:], (middle - tangents.middle)[owner])
    judge = tangents.lists.bites[leaders(height, tangents.lists.start)[1]]

    def work(rows: slice) -> Bools:
        floors = sweep.floors(middle[rows], points[rows], judge[rows], radius[rows])
        return floors.min(axis=0) > SLOPE * bow[rows]

    starts = np.arange(len(points) + 1) * points.shape[1]
    return np.concatenate(in_parallel(work, batches(starts)))
