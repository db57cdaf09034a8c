"""Encoders that read a wave into every turn, and where their axes really stand."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from twin.errors import InputError

Floats = NDArray[np.float64]

STEEPEST = 0.5
"""Largest slope of the error over the angle: beyond it no control would run."""
ROUNDS = 60


@dataclass(frozen=True, slots=True, kw_only=True)
class CyclicError:
    """At angle θ the encoder reads θ + A sin(order θ)."""

    amplitude_arcsec: float
    """A"""
    order: int = 1
    """waves per turn"""

    def __post_init__(self) -> None:
        slope = abs(math.radians(self.amplitude_arcsec / 3600.0)) * self.order
        if slope > STEEPEST:
            raise InputError(
                f"an encoder error of {self.amplitude_arcsec:g} arc seconds, {self.order} times a turn, is "
                "so steep that its axis could not be controlled",
                remedy=f"valid: up to {math.degrees(STEEPEST / self.order) * 3600.0:.6g}",
            )

    def angle(self, reading: Floats) -> Floats:
        """Where the axis stands [deg] when the encoder reads (n,) [deg]."""
        amplitude = self.amplitude_arcsec / 3600.0
        angle = reading.copy()
        for _ in range(ROUNDS):
            before = angle
            angle = reading - amplitude * np.sin(np.radians(self.order * angle))
            if np.array_equal(angle, before):
                break
        return angle


def stands(errors: Mapping[int, CyclicError], reading: Floats) -> Floats:
    """Where all axes stand when their encoders read (n, axes); `errors` by column."""
    actual = reading.copy()
    for column, error in errors.items():
        actual[:, column] = error.angle(reading[:, column])
    return actual
