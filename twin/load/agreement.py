"""The next forces to try, from all that were tried and what they have caused: Anderson's acceleration.

Metal that was cut short in one turn of the work stands in the way in the next, so plain rounds hand an error
on from turn to turn and need as many. The mixture of the tried forces that disagrees least with what it would
have caused, as far as both are linear, is what comes next: weights α with Σα = 1 that make
|Σ α (caused − acted)| least, and Σ α caused.
"""

from dataclasses import dataclass, field

import numpy as np

from twin.load.forces import CuttingLoad, mixed

KEPT = 4
"""rounds that are looked back on"""
ROUNDING = 1e-6


@dataclass(slots=True)
class Agreement:
    """The last rounds: forces that acted, and those that they have caused."""

    _rounds: list[tuple[CuttingLoad, CuttingLoad]] = field(default_factory=list)

    def after(self, acted: CuttingLoad, caused: CuttingLoad) -> CuttingLoad:
        """What to try next; all forces of earlier rounds come with the angles of the last motion."""
        last = [*self._rounds[-KEPT + 1 :], (acted, caused)]
        self._rounds = [(a.on(*caused.angle), c.on(*caused.angle)) for a, c in last[:-1]]
        self._rounds.append((acted.on(*caused.angle), caused))
        ticks = caused.angle[0]
        off = [(c.tool_force(ticks) - a.tool_force(ticks)).reshape(-1) for a, c in self._rounds]
        weights = np.ones(1)
        if len(off) > 1:
            towards = np.column_stack([one - off[-1] for one in off[:-1]])
            earlier = np.linalg.lstsq(towards, -off[-1], rcond=ROUNDING)[0]
            weights = np.asarray(np.append(earlier, 1.0 - earlier.sum()), dtype=np.float64)
        return mixed([c for _, c in self._rounds], weights)
