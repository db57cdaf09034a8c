"""The first sentence: what a foreman reads."""

from dataclasses import replace

import pytest

from twin.inspection.nominal import GearNominal, PolygonNominal
from twin.inspection.result import Inspection, Verdict
from twin.report import Message, ReportData, Severity
from twin.report.words import Tone, found, headline, wanted

ALARM = Message(
    severity=Severity.ALARM, number="PS0010", text="IMPROPER G-CODE", file="p.nc", line=3, column=1
)
WARNING = replace(ALARM, severity=Severity.WARNING)


def test_a_good_gear(sample):
    inspection = sample.gear_inspection()
    head = headline(ReportData(title="t", inspection=inspection, messages=(WARNING,)))
    assert head.tone is Tone.GOOD
    assert head.label == "In tolerance"
    assert head.sentence == (
        "The part is what was wanted: a spur gear with 20 teeth, module 2 mm, "
        "accuracy class 7 of ISO 1328-1 where class 8 was allowed."
    )


def test_a_wrong_part_says_what_came_and_what_was_wanted(sample):
    gear = replace(sample.gear_inspection().gear, number_of_teeth=21)
    nominal = GearNominal(number_of_teeth=20, normal_module_mm=2.0, helix_angle_deg=-20.0, accuracy_class=8)
    inspection = Inspection(
        gear=gear, nominal=nominal, verdict=Verdict.OUT, findings=("21 teeth instead of 20.",)
    )
    head = headline(ReportData(title="t", inspection=inspection))
    assert head.tone is Tone.BAD
    assert head.sentence == (
        "The part is not what was wanted. It came out as a spur gear with 21 teeth, module 2 mm; "
        "wanted was a left-hand helical gear with 20 teeth, module 2 mm, helix angle 20.00°, class 8."
    )
    assert head.findings == ("21 teeth instead of 20.",)


def test_the_right_gear_cut_too_coarsely(sample):
    inspection = sample.gear_inspection()
    gear = replace(inspection.gear, accuracy_class={"overall": 10})
    inspection = replace(inspection, gear=gear, verdict=Verdict.OUT)
    assert headline(ReportData(title="t", inspection=inspection)).sentence == (
        "The part is a spur gear with 20 teeth, module 2 mm, as wanted, but it is out of tolerance: "
        "class 10 of ISO 1328-1 reached, 8 allowed."
    )


def test_the_right_polygon_in_the_wrong_size(sample):
    inspection = sample.polygon_inspection()
    polygon = replace(inspection.polygon, across_flats_caliper_mm=17.166)
    inspection = replace(inspection, polygon=polygon, verdict=Verdict.OUT)
    assert headline(ReportData(title="t", inspection=inspection)).sentence == (
        "The part is a hexagon, 17.000 mm across flats, 17.166 mm by caliper, but out of tolerance: "
        "17 mm h13 was wanted."
    )


def test_the_reason_is_said_once():
    reason = "not a gear with 20 teeth: no regular teeth"
    inspection = Inspection(
        nominal=GearNominal(number_of_teeth=20, normal_module_mm=2.0),
        reason=reason,
        findings=(reason, "look again"),
    )
    head = headline(ReportData(title="t", inspection=inspection))
    assert head.sentence == "What came out is not a gear with 20 teeth: no regular teeth."
    assert head.findings == ("Look again.",)


def test_no_good_part_out_of_a_stopped_program(sample):
    head = headline(ReportData(title="t", inspection=sample.gear_inspection(), messages=(WARNING, ALARM)))
    assert head.tone is Tone.BAD
    assert head.label == "Stopped by an alarm"
    assert head.findings[0] == "The program stopped at p.nc:3:1 with PS0010 IMPROPER G-CODE."


def test_no_good_part_out_of_a_rapid_into_the_stock(sample):
    clash = replace(ALARM, number="HT9032", text="RAPID INTO THE STOCK", found="1.82 mm deep, at 1.450 s")
    head = headline(ReportData(title="t", inspection=sample.gear_inspection(), messages=(clash,)))
    assert head.tone is Tone.BAD
    assert head.label == "Tool ran into the stock"
    assert "stopped" not in head.findings[0]
    assert head.findings[0].startswith("HT9032 RAPID INTO THE STOCK at p.nc:3:1")


@pytest.mark.parametrize(
    ("inspection", "messages", "label", "sentence"),
    [
        (Inspection(), (ALARM,), "No part", "The program stopped before a part was made."),
        (Inspection(), (), "No part", "No part was made or measured."),
        (
            Inspection(reason="no teeth were found."),
            (),
            "Not recognised",
            "What came out is neither a gear nor a polygon: no teeth were found.",
        ),
        (
            Inspection(
                reason="no teeth were found", nominal=GearNominal(number_of_teeth=20, normal_module_mm=2.5)
            ),
            (),
            "Not the part",
            "What came out is not a spur gear with 20 teeth, module 2.5 mm: no teeth were found.",
        ),
    ],
)
def test_where_nothing_was_recognised(inspection, messages, label, sentence):
    head = headline(ReportData(title="t", inspection=inspection, messages=messages))
    assert (head.label, head.sentence) == (label, sentence)
    assert head.tone is not Tone.GOOD


def test_polygons_by_name(sample):
    assert found(sample.polygon_inspection()) == "a hexagon, 17.000 mm across flats"
    assert (
        wanted(PolygonNominal(number_of_sides=8, across_flats_mm=10.5))
        == "an octagon, 10.5 mm across flats h13"
    )
    assert (
        wanted(PolygonNominal(number_of_sides=7, across_flats_mm=10))
        == "a polygon with 7 sides, 10 mm across flats h13"
    )


def test_measured_but_not_judged(sample):
    inspection = replace(sample.polygon_inspection(), verdict=Verdict.NOT_GRADED)
    head = headline(ReportData(title="t", inspection=inspection))
    assert head.tone is Tone.OPEN
    assert (
        head.sentence
        == "The part came out as a hexagon, 17.000 mm across flats. It was measured, not judged."
    )


def test_a_gear_of_good_class_that_is_out_for_another_reason(sample):
    inspection = sample.gear_inspection()
    gear = replace(inspection.gear, accuracy_class={"overall": 6})
    inspection = replace(inspection, gear=gear, verdict=Verdict.OUT)
    assert headline(ReportData(title="t", inspection=inspection)).sentence == (
        "The part is a spur gear with 20 teeth, module 2 mm, with flanks of class 6, "
        "but it is not whole or not to size."
    )
