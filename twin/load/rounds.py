"""Round after round: the machine moves, the metal pushes back, the machine moves again under that push.

A run and its forces belong together when the forces that its chips cause move nothing any more. Where eight
rounds do not come to that, the cut is unstable: what it pushes away comes back as more force.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from controller.tables.alarms import Alarm
from twin.cutting.motion import CutterMotion
from twin.job.schema import Job
from twin.load.agreement import Agreement
from twin.load.forces import Clock, CuttingLoad, cutting_load
from twin.load.material import Material, material_of
from twin.load.removal import removal
from twin.session import Session
from twin.setup import Ready

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Run = Callable[[CuttingLoad | None], Session]

MOST_ROUNDS = 8
SETTLED_UM = 0.1
"""by how much the last round may still have moved the part's surface"""
STILL = 1e-6
"""[rad per sample] below which a tool does not turn"""
UM = 1e3


@dataclass(frozen=True, slots=True, kw_only=True)
class LoadedRun:
    """A run under its own cutting forces."""

    session: Session
    load: CuttingLoad
    """that acted on it"""
    material: Material
    rounds: int
    """runs that were made, the first one without forces"""
    moved_um: tuple[float, ...]
    """by how much at most each round but the first moved the part's surface"""
    frequency_hz: float | None
    """that the last round changed most; None where the rounds have settled"""
    resolution_mm: float
    """distance of the rays on which metal was counted"""
    tick_s: float

    @property
    def removed_mm3(self) -> float:
        """Metal that the forces belong to."""
        return float(self.load.removed_mm3.sum())

    @property
    def energy_j(self) -> float:
        """Work of cutting."""
        return float(self.load.power_w.sum()) * self.tick_s

    @property
    def mean_power_w(self) -> float:
        """While metal is removed."""
        return float(self.load.power_w.mean()) if len(self.load.tick) else 0.0

    @property
    def settled(self) -> bool:
        """Whether forces and motion belong together."""
        return self.frequency_hz is None


def run_under_load(
    job: Job,
    ready: Ready,
    run: Run,
    *,
    tell: Callable[[str], None] = lambda _text: None,
    progress: Callable[[float], None] = lambda _share: None,
) -> LoadedRun:
    """Run until forces and motion belong together, or for MOST_ROUNDS.

    `run(load)` runs the program under a load. The session of a cut that does not settle ends with the alarm
    HT9040. Raises InputError for a material without figures.
    """
    material = material_of(job.work.material, job.physics)
    blank, physics, tick_s = job.work.blank(), job.physics, ready.spec.control_period_s
    kinematics = ready.tools[0].kinematics
    resolution = 0.0

    def caused(session: Session) -> CuttingLoad:
        nonlocal resolution
        metal = removal(blank, session.motions, resolution_mm=physics.load_resolution_mm, progress=progress)
        resolution = metal.resolution_mm
        motions = tuple(motion for _, motion in session.motions)
        clock = Clock.of(session.recording, tick_s)
        return cutting_load(
            metal, motions, kinematics=kinematics, material=material, physics=physics, clock=clock
        )

    session = run(None)
    load = caused(session)
    change, when = np.zeros((0, 4)), np.zeros(0, np.int64)
    moved: list[float] = []
    agreement = Agreement()
    while len(load.tick) or moved:
        tell(f"cutting forces, round {len(moved) + 2} of at most {MOST_ROUNDS}")
        before, session = session, run(load)
        change, when = _change_um(before, session, load.tick, radius=blank.radius, tick_s=tick_s)
        moved.append(_bound(change))
        if moved[-1] < SETTLED_UM or len(moved) == MOST_ROUNDS - 1:
            break
        load = agreement.after(load, caused(session))
    settled = not moved or moved[-1] < SETTLED_UM
    frequency = None if settled else _dominant_hz(change, when, tick_s)
    if frequency is not None:
        session = replace(session, alarms=(*session.alarms, _unstable(moved, frequency)))
    return LoadedRun(
        session=session,
        load=load,
        material=material,
        rounds=len(moved) + 1,
        moved_um=tuple(moved),
        frequency_hz=frequency,
        resolution_mm=resolution,
        tick_s=tick_s,
    )


def _bound(change: Floats) -> float:
    """How far at most the part's surface has moved [µm]: the tool's way and the stock's turn together."""
    moved = np.linalg.norm(change[:, :3], axis=1) + np.abs(change[:, 3])
    return float(moved.max(initial=0.0))


def _change_um(
    before: Session, after: Session, ticks: Ints, *, radius: float, tick_s: float
) -> tuple[Floats, Ints]:
    """(m, 4) how the tool's place (3,) and the stock's surface about its axis have changed [µm], and (m,) in
    which of the `ticks`: those that both runs have.

    Compared where the edges stand alike: an edge that comes late meets the metal where that has gone on to.
    """
    changes, when = [np.zeros((0, 4))], [np.zeros(0, np.int64)]
    for (_, old), (_, new) in zip(before.motions, after.motions, strict=False):
        before_ticks, after_ticks = (np.rint(m.time_s / tick_s).astype(np.int64) - 1 for m in (old, new))
        common = np.intersect1d(np.intersect1d(before_ticks, after_ticks), ticks)
        a, b = np.searchsorted(before_ticks, common), np.searchsorted(after_ticks, common)
        places = [_places(motion, radius) for motion in (old, new)]
        change = places[1][b] - places[0][a]
        rate = np.gradient(places[1], axis=0)[b]
        turned, turning = new.tool_angle[b] - old.tool_angle[a], np.gradient(new.tool_angle)[b]
        late = np.divide(turned, turning, out=np.zeros(len(b)), where=np.abs(turning) > STILL)
        changes.append((change - late[:, None] * rate) * UM)
        when.append(common)
    return np.concatenate(changes), np.concatenate(when)


def _places(motion: CutterMotion, radius: float) -> Floats:
    """(n, 4) tool centre and way of the stock's surface [mm]."""
    return np.column_stack([motion.centre, radius * motion.work_angle])


def _dominant_hz(change: Floats, ticks: Ints, tick_s: float) -> float:
    """Frequency [Hz] with the largest amplitude in the last change (m, 4); none while nothing is cut."""
    if len(ticks) < 2:
        return 0.0
    whole = np.zeros((int(ticks[-1] - ticks[0]) + 1, change.shape[1]))
    whole[ticks - ticks[0]] = change
    power = (np.abs(np.fft.rfft(whole, axis=0)[1:]) ** 2).sum(axis=1)
    return float(np.fft.rfftfreq(len(whole), tick_s)[1 + int(np.argmax(power))])


def _unstable(moved: list[float], frequency: float) -> Alarm:
    rounds = ", ".join(f"{one:.3g}" for one in moved)
    return Alarm(
        number="HT9040",
        found=f"the part's surface still moved by {moved[-1]:.3g} µm in round {len(moved) + 1}, most at "
        f"{frequency:.4g} Hz (by round: {rounds} µm)",
    )
