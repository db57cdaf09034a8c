"""Forces and mounts in balance: an edge gives way by F/k, and bears less for it.

Both belong to each other in every tick, and at once, for mounts are springs without mass here. With forces
known on a motion in which the mounts gave way by δ₀, and their change S with a displacement, the balance

    F = F₀ + S (δ − δ₀),   δ = c F

is one linear system over the ticks: Newton's step on it. It has its solution however soft the mounts are,
where trying F₀ as it comes would lead away from it from |c S| = 1 on, which thin chips reach on any machine.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from twin.load.forces import Stiff
from twin.load.timeline import COLUMNS, CuttingLoad

Floats = NDArray[np.float64]

UM = 1e3
BAND = 5
"""diagonals to either side: of three components each, those of the next tick"""


def balanced(found: Stiff, before: CuttingLoad, given: Floats, *, first: int) -> CuttingLoad:
    """The forces of ticks `first` to the last one of `given`, in balance with the mounts.

    `found` on a motion in which the mounts gave way by `given` (n, 3) [µm] in the mean of each tick; `before`
    is what acts before. In the last tick mounts are taken to stand still.
    """
    from scipy.linalg import solve_banded  # noqa: PLC0415 - slow to load, and few runs need it

    count = len(given)
    load, compliance = found.load, found.load.compliance_um_per_n / UM
    tick = load.cell // load.parts - first
    forces, slope = np.zeros((count, 3)), np.zeros((count, 3, 3))
    np.add.at(forces, tick, load.tool / load.parts)
    np.add.at(slope, tick, found.tool / load.parts)
    share, held = _shares(count)
    (last,) = before.tool_force(np.array([first - 1]))
    known = held[:, None] * last * compliance
    # F − S (c · share · F) = F₀ + S (known − δ₀); each tick knows its neighbours alone
    system = np.eye(3 * count) - np.einsum("kij,kl->kilj", compliance * slope, share).reshape(3 * count, -1)
    right = forces + np.einsum("kij,kj->ki", slope, known - given / UM)
    solved = solve_banded((BAND, BAND), _bands(system), right.reshape(-1)).reshape(count, 3)
    moved = (known + compliance * share @ solved - given / UM)[tick]
    columns = {
        name: getattr(load, name) + np.einsum("n...j,nj->n...", getattr(found, name), moved)
        for name in COLUMNS
    }
    # a tooth that is out of the metal does not pull
    cuts = columns["power_w"] > 0.0
    columns = {name: np.where(cuts.reshape(-1, *[1] * (v.ndim - 1)), v, 0.0) for name, v in columns.items()}
    return replace(load, **columns)


def _bands(matrix: Floats) -> Floats:
    """(2 BAND + 1, n) diagonals of a matrix (n, n), from the highest on, as LAPACK wants them."""
    n = len(matrix)
    out = np.zeros((2 * BAND + 1, n))
    for row in range(2 * BAND + 1):
        off = BAND - row
        out[row, max(off, 0) : n + min(off, 0)] = np.diagonal(matrix, off)
    return out


def _shares(count: int) -> tuple[Floats, Floats]:
    """(n, n) share of each tick's force in the mean give of each tick, and (n,) that of the one before them.

    At a tick's end mounts stand between its force and the next one's, in its mean between these ends.
    """
    ends = np.zeros((count + 1, count + 1))
    rows = np.arange(count)
    ends[rows, rows] = ends[rows, rows + 1] = 0.5
    ends[-1] = ends[-2]
    mean = 0.5 * (ends[:-1] + ends[1:])
    return mean[:, 1:], mean[:, 0]
