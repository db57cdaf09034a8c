"""Engaging and releasing the gear box in time, and what the registers learn of it.

Hobbing, 开始同步 … 解除同步; polygon, 同步控制. There is no ramp on the coupling itself: phase is what both
axes hold when it engages. Releasing it while it turns brakes the slave, and the braking travel counts.
"""

import math
from dataclasses import dataclass, field, replace

from controller.laws.gearbox import GearBox, SyncKind, slave_travel
from controller.laws.segments import trapezoid
from controller.motion.peaks import Peaks
from controller.motion.registers import Registers
from controller.motion.requests import Sensor
from controller.motion.spindles import Spindles
from controller.motion.timeline import Epoch, Timeline
from controller.tables.machine_data import MachineData


@dataclass(frozen=True, slots=True, kw_only=True)
class SyncInterval:
    """A stretch of time in which the gear box was engaged."""

    kind: SyncKind
    start_s: float
    end_s: float
    """inf while it is engaged"""
    first_line: int | None
    """of the block that engaged it"""
    last_line: int | None = None
    """of the block, or the action, that released it"""


@dataclass(slots=True)
class Coupling:
    """The gear box in time."""

    machine: MachineData
    timeline: Timeline
    registers: Registers
    spindles: Spindles
    peaks: Peaks
    intervals: list[SyncInterval] = field(default_factory=list)
    """when and where the gear box was engaged"""
    moved: dict[int, float] = field(default_factory=dict)
    """column -> sync motion since the gear box was first engaged [deg]"""
    _master_from: float = 0.0

    @property
    def gear(self) -> GearBox | None:
        """The gear box that is engaged."""
        epoch = self.timeline.coupling
        return epoch.gear if epoch else None

    def engage(self, gear: GearBox, time: float, sensor: Sensor | None, line: int | None) -> float:
        """Engage at `time`; returns the speed that the master gives the slave [deg/s]."""
        own = self.timeline.own(time)
        self._master_from = own[gear.master]
        last = self.intervals[-1] if self.intervals else None
        if last and last.end_s == time and last.kind is gear.kind:
            self.intervals[-1] = replace(last, end_s=math.inf, last_line=None)
        else:
            self.intervals.append(SyncInterval(kind=gear.kind, start_s=time, end_s=math.inf, first_line=line))
        self.timeline.epochs.append(
            Epoch(
                gear=gear,
                start=time,
                master_start=sensor.position(gear.master) if sensor and gear.follow else self._master_from,
                slides_start=own,
                weights=self._weights(gear),
            )
        )
        return gear.ratio * self.timeline.tracks[gear.master].speed(time)

    def close(self, time: float, sensor: Sensor | None, line: int | None) -> float:
        """End the open epoch: the slave's own track takes over its position; returns its speed [deg/s]."""
        epoch = self.timeline.coupling
        if epoch is None:
            return 0.0
        gear, own, track = epoch.gear, self.timeline.own(time), self.timeline.tracks[epoch.gear.slave]
        tracks = self.timeline.tracks
        master, speed = own[gear.master], self.timeline.speed(gear.slave, time)
        speed += sum(weight * tracks[k].speed(time) for k, weight in epoch.weights.items())
        shift = epoch.shift(own)
        if sensor and gear.follow:
            rotation = sensor.command(gear.slave) - own[gear.slave] - shift
            speed = sensor.command_speed(gear.slave)
        else:
            rotation = slave_travel(gear, master - epoch.master_start)
        epoch.end = time
        self.intervals[-1] = replace(self.intervals[-1], end_s=time, last_line=line)
        track.add(time, own[gear.slave] + rotation + shift)
        counted = rotation + (shift if gear.kind is SyncKind.POLYGON else 0.0)
        self.moved[gear.slave] = self.moved.get(gear.slave, 0.0) + counted
        self.moved[gear.master] = self.moved.get(gear.master, 0.0) + master - self._master_from
        return speed

    @property
    def highest(self) -> float:
        """Speed of the master [rpm] at which the slave meets its limit; inf out of sync."""
        gear = self.gear
        return self.machine.axes[gear.slave].spindle_max / abs(gear.ratio) if gear else math.inf

    def note_peaks(self, speed: float, acceleration: float) -> None:
        """The master has had this speed and acceleration [deg/s, deg/s²]: so has the slave by its ratio."""
        if gear := self.gear:
            self.peaks.note({gear.slave: gear.ratio}, speed, acceleration)

    def advance_master(self, gear: GearBox, angle: float, time: float) -> float:
        """R of G51.2: turn the master by `angle` [deg] at rapid; returns the end [s]."""
        axis = self.machine.axes[gear.master]
        track = self.timeline.tracks[gear.master]
        start, end = track.at(time), time
        for phase in trapezoid(angle, speed=axis.rapid, acceleration=axis.acceleration):
            track.add(end, start + phase.start, phase.speed, phase.acceleration)
            end += phase.duration
            self.peaks.note({gear.master: 1.0}, phase.speed, abs(phase.acceleration))
        track.add(end, start + angle)
        return end

    def count_advance(self, gear: GearBox, angle: float) -> None:
        """R of G51.2 counts as sync motion (rulings, section 3)."""
        self.moved[gear.master] = self.moved.get(gear.master, 0.0) + angle

    def ramp(self) -> float | None:
        """Acceleration of the master [deg/s²] that the slave can follow, too; None out of sync."""
        gear = self.gear
        if gear is None:
            return None
        slave = self.machine.axes[gear.slave].acceleration / abs(gear.ratio)
        return min(self.machine.axes[gear.master].acceleration, slave)

    def release(self, time: float, sensor: Sensor | None, line: int | None) -> float:
        """Let go at `time`: the slave brakes, the master keeps its speed. Returns the end of braking [s]."""
        gear = self.gear
        if gear is None:
            return time
        speed = self.close(time, sensor, line)
        track = self.timeline.tracks[gear.slave]
        end = time
        if speed != 0.0:
            rate = self.machine.axes[gear.slave].acceleration
            start, duration = track.at(time), abs(speed) / rate
            end, travel = time + duration, 0.5 * speed * duration
            track.add(time, start, speed, -math.copysign(rate, speed))
            track.add(end, start + travel)
            self.moved[gear.slave] += travel
        master = self.timeline.tracks[gear.master]
        if self.spindles.driven(gear.master, time):
            self.moved[gear.master] += master.at(end) - master.at(time)
            self.spindles.free.add(gear.master)
        for axis, angle in self.moved.items():
            self.registers.release(axis, angle)
        self.moved = {}
        return end

    def _weights(self, gear: GearBox) -> dict[int, float]:
        """Slave shift per slide travel: the axial travel is Cartesian, whatever slides make it."""
        if gear.axial is None:
            return {}
        pair = self.machine.pair
        if pair is None or gear.axial not in (pair.inclined, pair.orthogonal):
            return {gear.axial: gear.axial_rate}
        across, along = pair.to_cartesian(0.0, 1.0)
        if gear.axial == pair.inclined:
            return {pair.inclined: gear.axial_rate * along}
        return {pair.orthogonal: gear.axial_rate, pair.inclined: gear.axial_rate * across}
