"""Where bodies met that must not, with the machine as it stood then: what the picture of it shows."""

import numpy as np

from twin.machine.collisions import Touch, touch_at
from twin.machine.silhouette import outlines
from twin.outcome import Outcome
from twin.report.data import Contact

COLLISION = "HT9030"
CUTTER_AND_STOCK = ("cutter", "blank")


def contact_of(outcome: Outcome) -> Contact | None:
    """The collision that ended the run, else the first clash of cutter and stock; None where all was well."""
    session = outcome.session
    time = session.recording.time_s
    if not len(time):
        return None
    for alarm in session.alarms:
        if alarm.number == COLLISION:
            return _contact(outcome, len(time) - 1, alarm.found, None)
    if session.clashes:
        clash = session.clashes[0]
        row = min(int(np.searchsorted(time, clash.time_s)), len(time) - 1)
        return _contact(outcome, row, clash.alarm.found, Touch(bodies=CUTTER_AND_STOCK, point=clash.point))
    return None


def _contact(outcome: Outcome, row: int, found: str, touch: Touch | None) -> Contact | None:
    """The machine at a row of the recording; `touch` is looked up where it is not known."""
    recording, tools = outcome.session.recording, outcome.ready.tools
    number, axes = int(recording.tool[row]), recording.actual[row]
    assembly = next((t for t in tools if t.number == number), tools[0]).assembly
    touch = touch or touch_at(assembly, axes)
    if touch is None:
        return None
    return Contact(
        bodies=touch.bodies,
        point=touch.point,
        shapes=tuple((shape.body, shape.points) for shape in outlines(assembly, axes)),
        found=found,
    )
