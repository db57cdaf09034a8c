"""Waviness: the largest orders per gear turn in traces placed at their rotation angle (inspection.md, 1).

A wave that runs once round the gear k times shows on every flank, cut into as many pieces as there are teeth.
The pieces overlap or leave gaps, so the orders are no Fourier series: they are fitted by least squares, the
largest first, all found so far anew with each.
"""

import numpy as np
from numpy.typing import NDArray

from twin.inspection.result import Wave
from twin.inspection.solid import Floats

Complexes = NDArray[np.complex128]

ORDERS = 10
"""how many are reported"""
HIGHEST = 5000
"""no order above this is looked for"""
NOTHING = 5e-3
"""an amplitude below this [µm] is the noise of the figures: none"""
TELLING = 1e-3
"""an order of which less than this part is left beside the common bend of all flanks is not told apart"""
WHOLE = 0.98
"""part of a trace's points that must be there"""


def waviness(turn: Floats, centres: Floats, deviation: Floats, *, highest: float) -> tuple[Wave, ...]:
    """Return the largest orders, largest first.

    What all flanks have in common up to second order (slope and crowning) is no wave and is left out.

    Args:
        turn: (m,) rotation angle of each point of a trace from its tooth [rad].
        centres: (z,) rotation angle of each tooth [rad].
        deviation: (m, z) [µm]; traces with holes are left out.
        highest: order to look up to.

    """
    there = np.isfinite(deviation)
    if len(turn) < 4 or not (whole := there.mean(axis=0) >= WHOLE).any():
        return ()
    at = np.arange(len(turn))
    rows = np.array(
        [np.interp(at, at[ok], y[ok]) for y, ok in zip(deviation.T[whole], there.T[whole], strict=True)]
    )
    centres = centres[whole]
    common = np.linalg.qr(np.vander((turn - turn.mean()) / np.ptp(turn), 3))[0]
    rows = rows - rows.mean(axis=0) @ common @ common.T
    orders = np.arange(1, int(min(highest, HIGHEST)) + 1)
    if len(orders) == 0:
        return ()
    along, around = np.exp(1j * np.outer(orders, turn)), np.exp(1j * np.outer(orders, centres))
    tell = _Columns(along, around, common)
    chosen: list[int] = []
    basis = np.zeros((rows.size, 0))
    rest, weights = rows.ravel(), np.zeros(0)
    for _ in range(min(ORDERS, len(orders))):
        power = tell.power(rest.reshape(rows.shape))
        power[chosen] = 0.0
        best = int(np.argmax(power))
        if power[best] <= NOTHING**2 / 2 * rows.size:
            break
        chosen.append(best)
        wave = np.outer(around[best], along[best])
        wave = wave - wave.mean(axis=0) @ common @ common.T
        basis = np.column_stack([basis, wave.real.ravel(), wave.imag.ravel()])
        weights = np.linalg.lstsq(basis.T @ basis, basis.T @ rows.ravel(), rcond=1e-10)[0]
        rest = rows.ravel() - basis @ weights
    sizes = np.hypot(weights[::2], weights[1::2])
    found = (
        Wave(order=int(orders[k]), amplitude_um=float(size)) for k, size in zip(chosen, sizes, strict=True)
    )
    return tuple(sorted((w for w in found if w.amplitude_um >= NOTHING), key=lambda w: -w.amplitude_um))


class _Columns:
    """Cosine and sine of every order over all traces, the common bend taken out: never written out whole."""

    def __init__(self, along: Complexes, around: Complexes, common: Floats) -> None:
        """`along` (orders, m) over one trace, `around` (orders, teeth), `common` (m, 3) orthonormal."""
        self.around = around
        # apart: products of matrices with holes between their numbers take five times as long
        self.real, self.imag = np.ascontiguousarray(along.real), np.ascontiguousarray(along.imag)
        teeth, points = around.shape[1], along.shape[1]
        bend = self.real @ common + 1j * (self.imag @ common)
        mean = around.mean(axis=1)
        length = teeth * (points - np.abs(mean) ** 2 * (np.abs(bend) ** 2).sum(axis=1))
        square = (around**2).sum(axis=1) * (along**2).sum(axis=1) - teeth * mean**2 * (bend**2).sum(axis=1)
        self.cosine, self.sine = (length + square.real) / 2, (length - square.real) / 2
        self.mixed = square.imag / 2
        self.determinant = self.cosine * self.sine - self.mixed**2
        self.told = self.determinant > TELLING * (teeth * points / 2) ** 2

    def power(self, rest: Floats) -> Floats:
        """Return how much of the squares of `rest` (teeth, m) a wave of each order takes away, (orders,)."""
        over = self.real @ rest.T + 1j * (self.imag @ rest.T)
        fit = (self.around * over).sum(axis=1)
        c, s = fit.real, fit.imag
        gain = self.sine * c**2 - 2 * self.mixed * c * s + self.cosine * s**2
        return np.where(self.told, gain / np.where(self.told, self.determinant, 1.0), 0.0)
