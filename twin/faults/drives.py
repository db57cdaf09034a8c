"""Faults that the machine's drives have to live with."""

from collections.abc import Mapping
from dataclasses import replace

from twin.faults.encoders import CyclicError
from twin.machine import Assembly

TURN_DEG = 360.0


def misread(assembly: Assembly, errors: Mapping[int, CyclicError]) -> Assembly:
    """The machine with cyclic errors in its encoders, by column, in place of those of its parameter file."""
    drives = dict(assembly.spec.drives)
    for column, error in errors.items():
        joint = assembly.joints[column]
        drives[joint] = replace(
            drives[joint],
            encoder_cyclic_error=error.amplitude_arcsec,
            # the drive counts its waves by turns of the motor
            encoder_cyclic_order=error.order * drives[joint].travel_per_turn / TURN_DEG,
        )
    return replace(assembly, spec=replace(assembly.spec, drives=drives)) if errors else assembly
