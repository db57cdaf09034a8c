"""`python -m models.response_table NAME`: measures every drive of a machine for the table of its README.

Each row is driven in MuJoCo with a hob Ø70 × 80 and a blank Ø44 × 20 mounted: small signals, Coulomb
friction off, encoders exact, so that the figures are those of the loop. `off` is the largest distance of the
measured frequency response from the loop's transfer function.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from controller.clock import Chunk, Floats
from twin.machine import MachineSpec, MujocoMachine, Setup, ToolMount, WorkMount, assemble, load_machine
from twin.machine.loops import Loops
from twin.machine.servo import tune
from twin.machine.stability import position_gain_limit

BEGIN, END = "<!-- drives: python -m models.response_table -->", "<!-- end of drives -->"
HERTZ = np.array([1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0])
"""whole periods in the second that is measured"""
SMALL = 1e-3
"""[mm | deg]"""
HEAD = (
    "| axis | moved inertia | k_ff, k_a | −3 dB [Hz] | peak | phase at 10 Hz [°] | overshoot of a step "
    "| rise 10-90 % [ms] | unstable from Kv [1/s] | off |\n|---|---|---|---|---|---|---|---|---|---|"
)


def mounted(spec: MachineSpec, setup: Setup) -> MujocoMachine:
    """The machine with a hob over a blank."""
    work = WorkMount(diameter_mm=44.0, length_mm=20.0, arbor_diameter_mm=21.0)
    tool = ToolMount(carrier_swivel_deg=90.0, radius_mm=35.0, length_mm=80.0, edges=12)
    return MujocoMachine(assemble(spec, setup, work=work, tool=tool))


def linear(spec: MachineSpec, feedforward: float | None) -> MachineSpec:
    """The machine without what is not linear; `feedforward` in place of both shares, None = as delivered."""
    drives = {
        joint: replace(
            d,
            coulomb_friction=0.0,
            encoder_counts=0.0,
            velocity_feedforward=d.velocity_feedforward if feedforward is None else feedforward,
            acceleration_feedforward=d.acceleration_feedforward if feedforward is None else feedforward,
        )
        for joint, d in spec.drives.items()
    }
    return replace(spec, drives=drives)


def moved(machine: MujocoMachine, axis: int, command: Floats) -> Floats:
    """(n,) what one axis makes of its (n,) setpoints while the others stand."""
    n = len(command)
    setpoint = np.zeros((n, len(machine.assembly.joints)))
    setpoint[:, axis] = command
    none = np.zeros(n)
    chunk = Chunk(
        first_tick=0,
        setpoint=setpoint,
        block=none.astype(np.int32),
        sync=none.astype(bool),
        tool=none.astype(np.int16),
    )
    return machine.advance(chunk).actual[:, axis]


def row(spec: MachineSpec, setup: Setup, axis: int, feedforward: float | None) -> str:
    """One line of the table."""
    spec = linear(spec, feedforward)
    machine = mounted(spec, setup)
    assembly, period = machine.assembly, spec.control_period_s
    drives, mass = assembly.drives(), assembly.inertia()
    loop = Loops(
        mass=mass,
        viscous=np.array([d.drive.viscous_friction for d in drives]),
        gains=[tune(d, float(i)) for d, i in zip(drives, mass.diagonal(), strict=True)],
        period_s=period,
        substeps=spec.substeps,
    )
    second = round(1.0 / period)
    t = np.arange(1, 2 * second + 1) * period
    command = SMALL * (np.sin(2 * np.pi * HERTZ * t[:, None]) / HERTZ).sum(axis=1)
    bins = np.rint(HERTZ).astype(int)
    answer = np.fft.rfft(moved(machine, axis, command)[second:]) / np.fft.rfft(command[second:])
    off = np.abs(answer[bins] - loop.frequency_response(HERTZ)[:, axis, axis]).max()
    fine = np.geomspace(0.5, 0.49 / period, 4000)
    response = loop.frequency_response(fine)[:, axis, axis]
    weak = np.flatnonzero(np.abs(response) < np.sqrt(0.5))
    edge = f"{fine[weak[0]]:.0f}" if len(weak) else "—"
    phase = np.degrees(np.angle(loop.frequency_response(np.array([10.0]))[0, axis, axis]))
    step = moved(mounted(spec, setup), axis, np.full(second // 2, SMALL)) / SMALL
    rise = (np.argmax(step >= 0.9) - np.argmax(step >= 0.1)) * period * 1e3
    shares = drives[axis].drive.velocity_feedforward, drives[axis].drive.acceleration_feedforward
    limit = position_gain_limit(loop.alone(axis))
    name, unit = assembly.joints[axis], "kg" if drives[axis].unit == 1e-3 else "kg m²"
    return (
        f"| {name} | {mass[axis, axis]:.4g} {unit} | {shares[0]:g}, {shares[1]:g} | {edge} "
        f"| {np.abs(response).max():.3f} | {phase:.1f} | {max(step.max() - 1.0, 0.0):.1%} | {rise:.0f} "
        f"| {limit:.0f} | {off:.0e} |"
    )


def table(spec: MachineSpec) -> str:
    """Every axis, without feed-forward and as delivered."""
    lines = [HEAD]
    for joint in spec.setups[Setup.TILTED]:
        setup = next(s for s in (Setup.HOBBING, Setup.TILTED) if joint in spec.setups[s])
        axis = spec.setups[setup].index(joint)
        lines += [row(spec, setup, axis, share) for share in (0.0, None)]
    return "\n".join(lines)


def main(name: str) -> None:
    """Write the table into the README of a model."""
    spec = load_machine(name)
    path: Path = spec.folder / "README.md"
    text = path.read_text(encoding="utf-8")
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    path.write_text(f"{before}{BEGIN}\n{table(spec)}\n{END}{after}", encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1])
