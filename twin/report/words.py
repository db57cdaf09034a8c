"""The verdict in words: what came out, whether it is what was wanted, and why not."""

from dataclasses import dataclass
from enum import Enum

from twin.clashes.runs import CLASHES
from twin.inspection.nominal import GearNominal, Nominal, PolygonNominal
from twin.inspection.result import GearResult, Inspection, PolygonResult, Verdict
from twin.report.data import Message, ReportData, Severity
from twin.report.scale import MISSING, number, plain

POLYGONS = {3: "triangle", 4: "square", 5: "pentagon", 6: "hexagon", 8: "octagon"}
STRAIGHT_DEG = 0.05
"""a helix angle below this is not spoken of"""


class Tone(Enum):
    """What the headline says at a glance."""

    GOOD = "good"
    BAD = "bad"
    OPEN = "open"
    """nobody can say"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Headline:
    """The first thing on the page."""

    tone: Tone
    label: str
    """two or three words"""
    sentence: str
    findings: tuple[str, ...]
    """reasons, most important first"""


def headline(data: ReportData) -> Headline:
    """Judge by the inspection, but let nothing pass that ended in an alarm."""
    inspection = data.inspection
    alarms = [message for message in data.messages if message.severity is Severity.ALARM]
    stop = tuple(_stop(alarm) for alarm in alarms[:1])
    if inspection.kind is None:
        return _nothing(data, stop)
    came, findings = found(inspection), _findings(data, stop)
    if inspection.verdict is Verdict.OUT:
        sentence = _missed(inspection, came)
        return Headline(tone=Tone.BAD, label="Out of tolerance", sentence=sentence, findings=findings)
    if inspection.verdict is Verdict.NOT_GRADED:
        sentence = f"The part came out as {came}. It was measured, not judged."
        tone, label = Tone.OPEN, "Not graded"
    else:
        sentence = f"The part is what was wanted: {came}{_class_note(inspection)}."
        tone, label = Tone.GOOD, "In tolerance"
    if alarms and alarms[0].number in CLASHES:
        sentence += " But the tool took metal as it must not."
        tone, label = Tone.BAD, "Tool ran into the stock"
    elif stop:
        sentence += " But the program did not run to its end."
        tone, label = Tone.BAD, "Stopped by an alarm"
    return Headline(tone=tone, label=label, sentence=sentence, findings=findings)


def found(inspection: Inspection) -> str:
    """What the part is, as it was measured: "a spur gear with 20 teeth, module 2 mm"."""
    if inspection.gear:
        return _gear(inspection.gear)
    if inspection.polygon:
        return _polygon(inspection.polygon)
    return "nothing that could be measured"


def wanted(nominal: Nominal | None) -> str:
    """What the part should have been."""
    if nominal is None:
        return "not said"
    if isinstance(nominal, GearNominal):
        text = _gear_words(nominal.number_of_teeth, nominal.normal_module_mm, nominal.helix_angle_deg)
        return text + (f", class {nominal.accuracy_class}" if nominal.accuracy_class is not None else "")
    shape = _polygon_name(nominal.number_of_sides)
    return f"{shape}, {plain(nominal.across_flats_mm)} mm across flats {nominal.tolerance}"


def _missed(inspection: Inspection, came: str) -> str:
    gear, polygon, nominal = inspection.gear, inspection.polygon, inspection.nominal
    if polygon and isinstance(nominal, PolygonNominal) and polygon.number_of_sides == nominal.number_of_sides:
        width = polygon.across_flats_caliper_mm
        caliper = f", {number(width, 3)} mm by caliper" if width is not None else ""
        asked = f"{plain(nominal.across_flats_mm)} mm {nominal.tolerance}"
        return f"The part is {came}{caliper}, but out of tolerance: {asked} was wanted."
    if gear and isinstance(nominal, GearNominal) and wanted(nominal).startswith(came):
        reached, allowed = gear.accuracy_class.get("overall"), nominal.accuracy_class
        if reached is not None and allowed is not None and reached <= allowed:
            return f"The part is {came}, with flanks of class {reached}, but it is not whole or not to size."
        classes = f": class {reached} of ISO 1328-1 reached, {allowed} allowed" if reached else ""
        return f"The part is {came}, as wanted, but it is out of tolerance{classes}."
    return f"The part is not what was wanted. It came out as {came}; wanted was {wanted(nominal)}."


def _findings(data: ReportData, stop: tuple[str, ...]) -> tuple[str, ...]:
    """The stop first, then what the inspection found, as sentences; the reason has the headline to itself."""
    said = [finding.strip() for finding in data.inspection.findings if finding != data.inspection.reason]
    return stop + tuple(f"{text[0].upper()}{text[1:].rstrip('.')}." for text in said if text)


def _nothing(data: ReportData, stop: tuple[str, ...]) -> Headline:
    reason = data.inspection.reason.strip().rstrip(".")
    because = f": {reason}." if reason else "."
    findings = _findings(data, stop)
    if data.part is None and stop:
        return Headline(
            tone=Tone.BAD,
            label="No part",
            sentence="The program stopped before a part was made.",
            findings=findings,
        )
    if data.part is None and not reason:
        return Headline(
            tone=Tone.OPEN, label="No part", sentence="No part was made or measured.", findings=findings
        )
    if data.inspection.nominal is None:
        sentence = f"What came out is neither a gear nor a polygon{because}"
        return Headline(
            tone=Tone.BAD if stop else Tone.OPEN, label="Not recognised", sentence=sentence, findings=findings
        )
    said = reason if reason.startswith("not ") else f"not {wanted(data.inspection.nominal)}{because}"
    sentence = f"What came out is {said.rstrip('.')}."
    return Headline(tone=Tone.BAD, label="Not the part", sentence=sentence, findings=findings)


def _stop(alarm: Message) -> str:
    place = f" at {alarm.short_place}" if alarm.short_place else ""
    found_there = f": {alarm.found}" if alarm.found else ""
    if alarm.number in CLASHES:
        return f"{alarm.number} {alarm.text}{place}{found_there}."
    return f"The program stopped{place} with {alarm.number} {alarm.text}{found_there}."


def _gear(gear: GearResult) -> str:
    return _gear_words(gear.number_of_teeth, gear.normal_module_mm, gear.helix_angle_deg)


def _gear_words(teeth: int, module: float, helix: float) -> str:
    size = f"with {teeth} teeth, module {plain(round(module, 2))} mm"
    if abs(helix) < STRAIGHT_DEG:
        return f"a spur gear {size}"
    hand = "right" if helix > 0 else "left"
    return f"a {hand}-hand helical gear {size}, helix angle {number(abs(helix), 2)}°"


def _polygon(polygon: PolygonResult) -> str:
    width = number(polygon.across_flats_mm, 3)
    return f"{_polygon_name(polygon.number_of_sides)}, {width} mm across flats"


def _polygon_name(sides: int) -> str:
    name = POLYGONS.get(sides, f"polygon with {sides} sides")
    return f"{'an' if name[0] in 'o' else 'a'} {name}"


def _class_note(inspection: Inspection) -> str:
    gear, nominal = inspection.gear, inspection.nominal
    reached = gear.accuracy_class.get("overall") if gear else None
    if reached is None or not isinstance(nominal, GearNominal) or nominal.accuracy_class is None:
        return ""
    return f", accuracy class {reached} of ISO 1328-1 where class {nominal.accuracy_class} was allowed"


def missing(inspection: Inspection) -> tuple[tuple[str, str], ...]:
    """What could not be measured, and why."""
    return tuple((key.replace("_", " "), why or MISSING) for key, why in inspection.unmeasured.items())
