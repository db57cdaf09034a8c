"""G31: the machine stops the chunk at the signal, the controller brakes from there and knows where it was."""

import numpy as np
import pytest

from controller.clock import Feedback, WatchKind
from controller.cnc import Controller
from controller.dry_run import dry_run
from controller.language.source import parse_program
from controller.operator.actions import read_event
from controller.tables.parameters import delivered


class Wall:
    """Ideal drives, and a probe that touches when Z comes to a wall."""

    def __init__(self, z: float) -> None:
        self.z, self.watched = z, 0

    def advance(self, chunk) -> Feedback:
        rows = np.array(chunk.setpoint)
        if chunk.watch is not None:
            assert chunk.watch.kind is WatchKind.SKIP
            assert chunk.ticks <= chunk.watch.timeout_ticks
            self.watched += chunk.ticks
            beyond = np.flatnonzero(rows[:, 1] <= self.z)
            if len(beyond):
                n = int(beyond[0]) + 1
                return Feedback(ticks=n, setpoint=rows[:n], actual=rows[:n], latch=rows[n - 1] + 0.001)
        return Feedback(ticks=len(rows), setpoint=rows, actual=rows)


def run(text: str, wall: Wall, limit: int = 4096, *events: str):
    controller = Controller(
        parse_program(text), parameters=delivered(), events=[read_event(event) for event in events]
    )
    rows = []
    while (chunk := controller.propose(limit)).ticks:
        feedback = wall.advance(chunk)
        rows.append(feedback.setpoint)
        controller.commit(feedback)
    return controller, np.concatenate(rows)


TEXT = "G50 Z100.\nG01 X-2. F600\nG31 Z50. F600\n#1=#5062\nG01 Z#1 F600\nM30"


@pytest.mark.parametrize("limit", [1, 7, 4096])
def test_touch(limit: int) -> None:
    """10 mm/s: touched at the first tick at or beyond Z −12; 5 ms and 0.025 mm of braking; #5062 is where."""
    controller, motion = run(TEXT, Wall(-12.0), limit)
    assert controller.alarms == ()
    at = float(motion[np.flatnonzero(motion[:, 1] <= -12.0)[0], 1])
    assert motion[:, 1].min() == pytest.approx(at - 0.025, abs=1e-9)
    assert motion[-1, 1] == pytest.approx(round(at + 0.001, 3), abs=6e-4)
    assert np.abs(np.diff(motion[:, 1], n=2)).max() <= 2000e-6 * (1 + 1e-6)


def test_every_limit_gives_the_same_bits() -> None:
    reference = run(TEXT, Wall(-12.0))[1].tobytes()
    for limit in (1, 7, 100):
        assert run(TEXT, Wall(-12.0), limit)[1].tobytes() == reference


def test_without_a_touch_it_ends_at_its_end() -> None:
    wall = Wall(-500.0)
    controller, motion = run("G31 Z-20. F600\nG01 X-5.\nM30", wall)
    assert (motion[-1, 1], motion[-1, 0], controller.alarms) == (-20.0, -2.5, ())
    assert wall.watched == pytest.approx(2005, abs=1)  # and nothing is watched before or after


def test_hold_within_a_skip() -> None:
    """The signal is watched on the rest of the way as well."""
    controller, motion = run("G31 Z-20. F600\nM30", Wall(-12.0), 4096, "0.5 feed hold", "3 cycle start")
    assert controller.alarms == ()
    assert -12.05 < motion[-1, 1] <= -12.025
    assert np.ptp(motion[600:2900, 1]) == 0.0


def test_a_dry_run_says_that_it_cannot_know() -> None:
    found = dry_run(parse_program("G31 Z-20. F600\nM30"), delivered())
    assert [w.number for w in found.warnings] == ["HT9133"]
    assert found.absolute["Z"] == -20.0
