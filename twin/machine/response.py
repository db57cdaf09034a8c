"""How drives answer to a step and to sines: in MuJoCo, and by the transfer function of their closed loop.

Small signals without what is not linear (Coulomb friction, counts and cyclic error of encoders, play), so
that the two must agree to the last digits.
"""

# pyright: reportAttributeAccessIssue=false

import copy
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from controller.clock import Chunk, Floats
from twin.machine.assembly import Assembly, ToolMount, WorkMount, assemble
from twin.machine.drive import SI_PER_MM, AxisDrive, DriveKind
from twin.machine.loops import Loops
from twin.machine.physical import MujocoMachine
from twin.machine.servo import tune
from twin.machine.spec import MachineSpec
from twin.machine.stability import position_gain_limit

Complexes = NDArray[np.complex128]

HERTZ = np.array([1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0])
"""whole periods in the second that is measured"""
SMALL = 1e-3
"""[mm | deg]"""
STEP_S = 0.5


@dataclass(frozen=True, slots=True, kw_only=True)
class Response:
    """One axis, all others told to stand."""

    joint: str
    drive: AxisDrive
    inertia: float
    """it moves [kg | kg m²]"""
    hertz: Floats
    """(n,) of the sines that were measured"""
    measured: Complexes
    """(n,) position over setpoint in MuJoCo"""
    law_hertz: Floats
    """(m,) up to half of the control's frequency"""
    law: Complexes
    """(m,) the transfer function"""
    off: float
    """largest distance of `measured` from the transfer function"""
    time_s: Floats
    """(k,) after a step of the setpoint"""
    step: Floats
    """(k,) of it that MuJoCo has made"""
    step_law: Floats
    """(k,) that the closed loop's difference equation has made"""
    gain_limit: float
    """Kv [1/s] from which on the loop would be unstable"""

    @property
    def unit(self) -> str:
        """Of the inertia."""
        return "kg" if self.drive.unit == SI_PER_MM else "kg m²"

    @property
    def bandwidth_hz(self) -> float | None:
        """Where the amplitude falls below √½; None where it never does."""
        weak = np.flatnonzero(np.abs(self.law) < np.sqrt(0.5))
        return float(self.law_hertz[weak[0]]) if len(weak) else None

    @property
    def peak(self) -> float:
        """Largest amplitude."""
        return float(np.abs(self.law).max())

    @property
    def phase_at_10_hz_deg(self) -> float:
        """Of the position against the setpoint."""
        return float(np.degrees(np.angle(self.measured[self.hertz == 10.0][0])))

    @property
    def overshoot(self) -> float:
        """Of the step, as a share of it."""
        return max(float(self.step.max()) - 1.0, 0.0)

    @property
    def rise_s(self) -> float:
        """From a tenth of the step to nine."""
        return float(self.time_s[np.argmax(self.step >= 0.9)] - self.time_s[np.argmax(self.step >= 0.1)])


def delivered_responses(spec: MachineSpec) -> list[tuple[Response, Response]]:
    """Every axis of a machine, each in the first of its set-ups, with a hob Ø70 × 80 over a blank Ø44 × 20:
    without feed-forward and as it is. Raises InputError where the drives are not stable."""
    work = WorkMount(diameter_mm=44.0, length_mm=20.0, arbor_diameter_mm=21.0)
    tool = ToolMount(carrier_swivel_deg=90.0, radius_mm=35.0, length_mm=80.0, edges=12)
    found: dict[str, tuple[Response, Response]] = {}
    for setup in spec.setups:
        for pair in both_responses(assemble(spec, setup, work=work, tool=tool)):
            found.setdefault(pair[0].joint, pair)
    return list(found.values())


def both_responses(assembly: Assembly) -> list[tuple[Response, Response]]:
    """Every axis that has a position loop, without feed-forward and as it is."""
    return list(zip(responses(assembly, 0.0), responses(assembly), strict=True))


def responses(assembly: Assembly, feedforward: float | None = None) -> tuple[Response, ...]:
    """Every axis that has a position loop; `feedforward` in place of both shares, None = as they are.

    Raises InputError where the drives are not stable.
    """
    spec = _linear(assembly.spec, feedforward)
    model = copy.copy(assembly.joints_alone)
    model.dof_frictionloss[:] = 0.0
    assembly = replace(assembly, spec=spec, joints_alone=model)
    drives, mass = assembly.drives(), assembly.inertia()
    servos = [k for k, d in enumerate(drives) if d.drive.kind is DriveKind.SERVO]
    loops = Loops(
        mass=mass[np.ix_(servos, servos)],
        viscous=np.array([drives[k].drive.viscous_friction for k in servos]),
        gains=[tune(drives[k], float(mass[k, k])) for k in servos],
        period_s=spec.control_period_s,
        substeps=spec.substeps,
    )
    return tuple(_response(assembly, loops, place, axis) for place, axis in enumerate(servos))


def _response(assembly: Assembly, loops: Loops, place: int, axis: int) -> Response:
    """One axis, which is number `place` of the loops."""
    period = loops.period_s
    second = round(1.0 / period)
    t = np.arange(1, 2 * second + 1) * period
    shown = HERTZ[0.5 / period > HERTZ]
    command = SMALL * (np.sin(2 * np.pi * shown * t[:, None]) / shown).sum(axis=1)
    bins = np.rint(shown).astype(int)
    answer = np.fft.rfft(_moved(assembly, axis, command)[second:]) / np.fft.rfft(command[second:])
    fine = np.geomspace(0.5, 0.49 / period, 4000)
    ticks = round(STEP_S / period)
    return Response(
        joint=assembly.joints[axis],
        drive=assembly.drives()[axis],
        inertia=float(loops.mass[place, place]),
        hertz=shown,
        measured=answer[bins],
        law_hertz=fine,
        law=loops.frequency_response(fine)[:, place, place],
        off=float(np.abs(answer[bins] - loops.frequency_response(shown)[:, place, place]).max()),
        time_s=np.linspace(period, ticks * period, ticks),
        step=_moved(assembly, axis, np.full(ticks, SMALL)) / SMALL,
        step_law=loops.step_response(place, ticks),
        gain_limit=position_gain_limit(loops.alone(place)),
    )


def _linear(spec: MachineSpec, feedforward: float | None) -> MachineSpec:
    """The machine without what is not linear."""
    drives = {}
    for joint, drive in spec.drives.items():
        linear = replace(
            drive, coulomb_friction=0.0, encoder_counts=0.0, encoder_cyclic_error=0.0, backlash=0.0
        )
        if feedforward is not None:
            linear = replace(linear, velocity_feedforward=feedforward, acceleration_feedforward=feedforward)
        drives[joint] = linear
    return replace(spec, drives=drives)


def _moved(assembly: Assembly, axis: int, command: Floats) -> Floats:
    """(n,) what one axis makes of its (n,) setpoints [mm | deg]."""
    n = len(command)
    setpoint = np.zeros((n, len(assembly.joints)))
    setpoint[:, axis] = command
    none = np.zeros(n)
    chunk = Chunk(
        first_tick=0,
        setpoint=setpoint,
        block=none.astype(np.int32),
        sync=none.astype(bool),
        tool=none.astype(np.int16),
    )
    return MujocoMachine(assembly).advance(chunk).actual[:, axis]
