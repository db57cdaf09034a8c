"""A run under its own cutting forces, and what it comes to: a result, a tool that stalls, an unstable cut."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from controller.span import Span as Place
from controller.tables.alarms import Alarm
from twin.course import Course
from twin.job.schema import Job
from twin.load.change import dominant_hz
from twin.load.lines import Line, largest_line
from twin.load.material import Material
from twin.load.rounds import TICKS, Rounds, Window
from twin.load.stiffness import Stiffness
from twin.load.timeline import CuttingLoad, joined
from twin.load.walls import lean_of
from twin.session import Session, session_of
from twin.setup import Ready

Floats = NDArray[np.float64]

HEARD_S = 0.5
"""before the end, in which an unstable cut's frequency is looked for"""


@dataclass(frozen=True, slots=True, kw_only=True)
class LoadedRun:
    """A run under its own cutting forces."""

    session: Session
    load: CuttingLoad
    """that acted on it"""
    material: Material
    stiffness: Stiffness
    windows: int
    """in which metal was cut"""
    rounds: int
    """that the hardest of them has taken"""
    mean_rounds: float
    """of a window"""
    moved_um: tuple[float, ...]
    """by how much at most each round but the first of the hardest moved the part's surface"""
    settled: bool
    """whether forces and motion belong together up to the end"""
    frequency_hz: float | None
    """that an unstable cut trembles with; None where there is none, or it has just begun"""
    stalled: bool
    """whether the tool has come to rest in the metal"""
    torque_limit: float
    """of the tool's drive at its spindle [N m]"""
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
        return float(self.load.power_w.mean()) if len(self.load.cell) else 0.0

    @property
    def line(self) -> Line | None:
        """Largest in the spectrum of the tool's torque."""
        return largest_line(self.load, self.tick_s)

    @property
    def mean_torque(self) -> float:
        """On the tool spindle while metal is removed [N m]."""
        return float(np.abs(self.load.axes[:, self.load.spindle]).mean()) if len(self.load.cell) else 0.0


def run_under_load(
    job: Job,
    ready: Ready,
    course: Course,
    foreseen: Course,
    *,
    ticks: int = TICKS,
    tell: Callable[[str], None] = lambda _text: None,
) -> LoadedRun:
    """Run the program that `course` begins to its end, or to where rounds do not settle (HT9040) or the tool
    stalls in the metal (HT9041).

    `foreseen` is the same program's beginning on ideal axes, `ticks` of a window
    in which metal is cut, at most. Raises InputError for a material without figures.
    """
    tell("under its cutting forces, some ticks after the other")
    foreseen.go()
    lean = lean_of(job.work.blank(), session_of(foreseen, ready).motions)
    rounds = Rounds(job, ready, course, lean=lean, ticks=ticks)
    rounds.go()
    load = joined(rounds.past) if rounds.past else rounds.bench.no_load.whole()
    session = session_of(course, ready, load if len(load.cell) else None)
    windows = rounds.windows
    last = windows[-1] if windows else None
    hardest = max(windows, key=lambda one: (not one.settled, one.rounds), default=None)
    drives = ready.driven.drives()
    run = LoadedRun(
        session=session,
        load=load,
        material=rounds.bench.material,
        stiffness=rounds.bench.stiffness,
        windows=len(windows),
        rounds=hardest.rounds if hardest else 1,
        mean_rounds=float(np.mean([one.rounds for one in windows])) if windows else 1.0,
        moved_um=hardest.moved_um if hardest else (),
        settled=all(one.settled for one in windows),
        frequency_hz=None,
        stalled=False,
        torque_limit=drives[load.spindle].force_limit,
        resolution_mm=rounds.stock.step,
        tick_s=rounds.bench.tick_s,
    )
    if last is None or (last.settled and not last.stalled):
        return run
    stalled = last.stalled and (last.settled or _asked(run, last) > run.torque_limit)
    run = replace(run, stalled=True) if stalled else replace(run, frequency_hz=_frequency(run))
    alarm = _stalled(run, last) if stalled else _unstable(run, last)
    return replace(run, session=replace(session, alarms=(*session.alarms, alarm)))


def _frequency(run: LoadedRun) -> float | None:
    """That the mounts tremble with most, in the last moments of the cut [Hz]; None of a single tick."""
    recording = run.session.recording
    ticks = np.rint(recording.time_s / run.tick_s).astype(np.int64) - 1
    recent = run.load.tick[run.load.tick > ticks[-1] - round(HEARD_S / run.tick_s)]
    heard = ticks >= min(recent, default=ticks[-1])
    give = run.load.deflection_um(ticks[heard])
    return dominant_hz(give - give.mean(axis=0), ticks[heard], run.tick_s) or None


def _asked(run: LoadedRun, last: Window) -> float:
    """Largest torque that the last window's metal asks of the tool [N m]."""
    whole = last.load.whole().axes[:, run.load.spindle]
    return float(np.abs(whole).max(initial=0.0))


def _place(session: Session) -> Place:
    recording = session.recording
    block = recording.blocks[int(recording.block[-1])]
    return Place(file=block.file, line=block.line)


def _stalled(run: LoadedRun, last: Window) -> Alarm:
    recording, limit, load = run.session.recording, run.torque_limit, run.load
    recent = load.axes[load.cell > load.cell[-1] - round(HEARD_S / run.tick_s), load.spindle]
    asked = max(_asked(run, last), float(np.abs(recent).max(initial=0.0)))
    found = (
        f"at {recording.time_s[-1]:.3f} s the metal has braked the tool spindle to "
        f"{max(last.slowest, 0.0):.0%} of its speed: the cut asks for "
        f"{asked:.3g} N m, its drive has {limit:.3g} N m"
    )
    if asked > limit:
        # F_c = k_c1.1 b h^(1 − m_c), and h goes with the feed
        share = (limit / asked) ** (1.0 / (1.0 - run.material.m_c))
        found += f"; with {share:.2g} of this feed it would ask for no more"
    return Alarm(number="HT9041", found=found, span=_place(run.session))


def _unstable(run: LoadedRun, last: Window) -> Alarm:
    rounds = ", ".join(f"{one:.3g}" for one in last.moved_um)
    trembles = f"most at {run.frequency_hz:.4g} Hz" if run.frequency_hz else "in the first tick of a cut"
    return Alarm(
        number="HT9040",
        found=f"at {run.session.recording.time_s[-1]:.3f} s the part's surface still moves by "
        f"{last.moved_um[-1]:.3g} µm in round {last.rounds} of a single tick (by round: {rounds} µm), "
        f"{trembles}, with {_asked(run, last):.3g} N m on the tool",
        span=_place(run.session),
    )
