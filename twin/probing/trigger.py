"""When the signal of a touch probe comes, tick by tick, and where within the tick the axes are latched."""

import numpy as np

from twin.probing.probe import Probe


class Trigger:
    """One probe over a run; each touch draws its own pre-travel, so no chunking changes a bit of it."""

    def __init__(self, probe: Probe, period_s: float) -> None:
        """`period_s`: of the control's ticks."""
        self._probe = probe
        self._latency = probe.latency_s / period_s
        self._chance = np.random.default_rng(probe.seed)
        self._wait: float | None = None
        self._draw()

    def tick(self, before: float, after: float) -> float | None:
        """Share of this tick (0 to 1) after which the axes are latched; None where they are not.

        The stylus stood pushed back by `before` [mm] at the tick's begin, by `after` at its end.
        """
        if self._wait is None:
            if max(before, after) < self._limit:
                return None
            way = after - before
            share = 0.0 if before >= self._limit else (self._limit - before) / way
            self._wait = share + self._latency
        if self._wait > 1.0:
            self._wait -= 1.0
            return None
        share, self._wait = self._wait, None
        self._draw()
        return share

    def rest(self) -> None:
        """Nobody watches: a signal on its way is lost."""
        self._wait = None

    def _draw(self) -> None:
        chance = float(self._chance.standard_normal())
        self._limit = self._probe.pretravel_mm + chance * self._probe.repeatability_um * 1e-3
