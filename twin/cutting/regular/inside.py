"""Proof that everything before the shell is removed: in each block there, one bite is deep enough."""

import numpy as np
from numpy.typing import NDArray

from twin.cutting.local import Tangents
from twin.cutting.pairs import batches, in_parallel, leaders
from twin.cutting.regular.chart import Chart
from twin.cutting.regular.irregular import IrregularError
from twin.cutting.regular.tiles import Patches
from twin.cutting.sweep import Sweep

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

ROUNDS = 5
"""How often the way from the gap's middle to the shell is halved before it is given up."""
SLOPE = 1.1
"""Bound on a depth's gradient where the culling proves anything at all: the stock is slower than the edge."""


def prove_inside(sweep: Sweep, chart: Chart, patch: Patches, tangents: Tangents, thick: float) -> None:
    """Raise IrregularError unless all that lies before the shell on the rays of the patches is removed."""
    row = np.arange(len(patch.gap))
    near, far = np.zeros(len(row)), np.ones(len(row))
    for _ in range(ROUNDS):
        held = _removed(sweep, chart, patch.of(row), tangents.of(row), (near, far), thick)
        row, near, far = row[~held], near[~held], far[~held]
        if not len(row):
            return
        # close to the shell the bites that make the surface are deep enough only nearby
        middle = near + 0.25 * (far - near)
        row, near, far = np.tile(row, 2), np.concatenate([near, middle]), np.concatenate([middle, far])
    raise IrregularError("something is left standing in the gaps")


def _removed(
    sweep: Sweep, chart: Chart, patch: Patches, tangents: Tangents, part: tuple[Floats, Floats], thick: float
) -> Bools:
    """Whether one bite removes what lies on the rays of each patch, from share `part` to share `part` of the
    way from the shell back to the gap's middle."""
    cells = int((patch.i[:, 1] - patch.i[:, 0]).max())
    i = np.minimum(patch.i[:, :1] + np.arange(cells + 1), patch.i[:, 1:])[:, None, None, :]
    k = patch.k[:, None, :, None]
    share = np.stack(part, axis=1)[:, :, None, None]
    tau = -thick - share * (chart.inner[i] - thick)
    shape = np.broadcast_shapes(tau.shape, k.shape, i.shape)
    gap = patch.gap[:, None, None, None]
    points = chart.at(*(np.broadcast_to(v, shape) for v in (gap, i, k)), tau)[0].reshape(len(i), -1, 3)
    middle = 0.5 * (points.min(axis=1) + points.max(axis=1))
    radius = np.linalg.norm(points - middle[:, None], axis=2).max(axis=1)
    # between its ends a twisted gap leaves the chord
    turn = abs(chart.frame.indexing.twist) * (chart.z[patch.k[:, 1]] - chart.z[patch.k[:, 0]])
    bow = SLOPE * np.hypot(points[..., 0], points[..., 1]).max(axis=1) * turn**2 / 8.0
    owner = tangents.lists.owner()
    height = tangents.plane[0] + np.einsum("xm,mx->m", tangents.plane[1:], (middle - tangents.middle)[owner])
    judge = tangents.lists.bites[leaders(height, tangents.lists.start)[1]]

    def work(rows: slice) -> Bools:
        floors = sweep.floors(middle[rows], points[rows], judge[rows], radius[rows])
        return floors.min(axis=0) > bow[rows]

    starts = np.arange(len(i) + 1) * points.shape[1]
    return np.concatenate(in_parallel(work, batches(starts)))
