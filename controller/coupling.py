"""Engaging and releasing the gear box in time, and what the registers learn of it.

Hobbing, 开始同步 … 解除同步; polygon, 同步控制. There is no ramp on the coupling itself: phase is what both
axes hold when it engages. Releasing it while it turns brakes the slave, and the braking travel counts.
"""

import math
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from controller.gearbox import GearBox, SyncKind, slave_travel
from controller.inclined import cartesian_from_slides
from controller.machine_data import MachineData
from controller.registers import Registers
from controller.segments import trapezoid
from controller.spindles import Spindles
from controller.timeline import Epoch, Timeline


class Sensor(Protocol):
    """The encoders at the time the controller waited for."""

    def position(self, axis: int) -> float:
        """Measured position [mm | deg]."""
        ...

    def command(self, axis: int) -> float:
        """The setpoint as the drive saw it last [mm | deg]."""
        ...

    def command_speed(self, axis: int) -> float:
        """Speed of that setpoint over the last tick [mm/s | deg/s]."""
        ...

    def speed(self, axis: int) -> float:
        """Measured speed over the last feed period [mm/s | deg/s]."""
        ...


@dataclass(slots=True)
class Coupling:
    """The gear box in time."""

    machine: MachineData
    timeline: Timeline
    registers: Registers
    spindles: Spindles
    moved: dict[int, float] = field(default_factory=dict)
    """column -> sync motion since the gear box was first engaged [deg]"""
    _master_from: float = 0.0

    @property
    def gear(self) -> GearBox | None:
        """The gear box that is engaged."""
        epoch = self.timeline.coupling
        return epoch.gear if epoch else None

    def engage(self, gear: GearBox, time: float, sensor: Sensor | None) -> float:
        """Engage at `time`; returns the speed that the master gives the slave [deg/s]."""
        own = self.timeline.own(time)
        self._master_from = float(own[gear.master])
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

    def close(self, time: float, sensor: Sensor | None) -> float:
        """End the open epoch: the slave's own track takes over its position; returns its speed [deg/s]."""
        epoch = self.timeline.coupling
        if epoch is None:
            return 0.0
        gear, own, track = epoch.gear, self.timeline.own(time), self.timeline.tracks[epoch.gear.slave]
        master, speed = float(own[gear.master]), self.timeline.speed(gear.slave, time)
        shift = float(epoch.shift(own))
        if sensor and gear.follow:
            rotation = sensor.command(gear.slave) - float(own[gear.slave]) - shift
            speed = sensor.command_speed(gear.slave)
        else:
            rotation = slave_travel(gear, master - epoch.master_start)
        epoch.end = time
        track.add(time, float(own[gear.slave]) + rotation + shift)
        counted = rotation + (shift if gear.kind is SyncKind.POLYGON else 0.0)
        self.moved[gear.slave] = self.moved.get(gear.slave, 0.0) + counted
        self.moved[gear.master] = self.moved.get(gear.master, 0.0) + master - self._master_from
        return speed

    def advance_master(self, gear: GearBox, angle: float, time: float) -> float:
        """R of G51.2: turn the master by `angle` [deg] at rapid; returns the end [s]. It is sync motion."""
        axis = self.machine.axes[gear.master]
        track = self.timeline.tracks[gear.master]
        start, end = track.at(time), time
        for phase in trapezoid(angle, speed=axis.rapid, acceleration=axis.acceleration):
            track.add(end, start + phase.start, phase.speed, phase.acceleration)
            end += phase.duration
        track.add(end, start + angle)
        self.moved[gear.master] = self.moved.get(gear.master, 0.0) + angle
        return end

    def ramp(self) -> float | None:
        """Acceleration of the master [deg/s²] that the slave can follow, too; None out of sync."""
        gear = self.gear
        if gear is None:
            return None
        slave = self.machine.axes[gear.slave].acceleration / abs(gear.ratio)
        return min(self.machine.axes[gear.master].acceleration, slave)

    def release(self, time: float, sensor: Sensor | None) -> float:
        """Let go at `time`: the slave brakes, the master keeps its speed. Returns the end of braking [s]."""
        gear = self.gear
        if gear is None:
            return time
        speed = self.close(time, sensor)
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

    def _weights(self, gear: GearBox) -> np.ndarray:
        """Slave shift per slide travel: the axial travel is Cartesian, whatever slides make it."""
        if gear.axial is None:
            return np.zeros(len(self.machine.axes))
        return gear.axial_rate * cartesian_from_slides(len(self.machine.axes), self.machine.pair)[gear.axial]
