"""`[faults] encoder_cyclic_…` of a job, held against the axes that its machine has."""

from controller.tables.machine_data import MachineData
from twin.errors import InputError, Place
from twin.faults.encoders import CyclicError
from twin.job.locate import line_of
from twin.job.schema import Job


def encoder_errors(job: Job, machine: MachineData) -> dict[int, CyclicError]:
    """Cyclic errors of a job's encoders, by column of the axis.

    Raises InputError, at the line, for an axis that the machine does not have or that does not turn, for an
    order without an amplitude, and for an error that is too steep.
    """
    amplitudes, orders = job.faults.encoder_cyclic_arcsec, job.faults.encoder_cyclic_order
    rotary = {axis.letter: axis.number - 1 for axis in machine.axes if axis.rotary}
    for letter in orders:
        if letter not in amplitudes:
            raise InputError(
                f"faults.encoder_cyclic_order: {letter} has no amplitude",
                place=_place(job, "encoder_cyclic_order", letter),
                remedy=f"encoder_cyclic_arcsec.{letter} too",
            )
    found: dict[int, CyclicError] = {}
    for letter, amplitude in amplitudes.items():
        place = _place(job, "encoder_cyclic_arcsec", letter)
        if letter not in rotary:
            raise InputError(
                f"faults.encoder_cyclic_arcsec: {letter!r} is no rotary axis of this machine",
                place=place,
                remedy=f"valid: {', '.join(rotary)}",
            )
        try:
            found[rotary[letter]] = CyclicError(amplitude_arcsec=amplitude, order=orders.get(letter, 1))
        except InputError as cause:
            raise InputError(cause.text, place=place, remedy=cause.remedy) from cause
    return found


def _place(job: Job, table: str, letter: str) -> Place:
    text = job.path.read_text(encoding="utf-8")
    return Place(file=str(job.path), line=line_of(text, ("faults", table, letter)))
