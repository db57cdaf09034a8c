"""Each kind of advice where it is due, at its block, nothing else beside it; silence where it is not."""

import math

import pytest

from twin.advice.kinds import KINDS, Kind, Weight
from twin.inspection.tolerances import GearSize, gear_tolerance

SPUR, HELICAL, HEXAGON = "spur_m2_z20", "helical_m2_z20_right", "hexagon_af17"
G81, CUT = "N0030 G81 T20 L1 ;", "N0060 G01 Z-38. F2. ;"
G81_HELICAL = "N0030 G81 T20 L1 Q2. P20. ;"
SYNC_201_4 = {'parameters = { "201#2" = 1 }': 'parameters = { "201#2" = 1, "201#4" = 1 }'}


@pytest.mark.parametrize(
    ("scene", "expected"),
    [
        (SPUR, []),
        (HELICAL, []),
        ("helical_m2_z20_left", []),
        (HEXAGON, []),
        ("square_af10", []),
        ("hexagon_af17_original", [(Kind.CONCAVE, 6)]),
        ("wrong_hand", [(Kind.HAND_OF_HOB, 6)]),
        ("stopped_halfway", [(Kind.FACE_NOT_COVERED, 9)]),
    ],
)
def test_scenes_pass_clean_but_for_what_is_wrong_on_purpose(scenes, advice_of, scene, expected):
    found = advice_of(scenes / scene)
    assert [(a.kind, a.span.line if a.span else None) for a in found] == expected


ONE = [
    (HEXAGON, {"inserts = 3": "inserts = 2"}, {}, [(Kind.INSERTS, 6), (Kind.SIDES, 6)]),
    (HEXAGON, {}, {"P3 Q6": "P6 Q12"}, [(Kind.INSERTS, 6)]),
    (HEXAGON, {}, {"P3 Q6": "P3 Q3"}, [(Kind.SIDES, 6)]),
    (HEXAGON, {}, {"P3 Q6": "P3 Q-6"}, [(Kind.CONCAVE, 6)]),
    (HEXAGON, {}, {"P3 Q6": "P3 Q6 A200."}, [(Kind.TWISTED, 6)]),
    (HEXAGON, {}, {"G01 X17.": "G01 X16.72"}, [(Kind.ACROSS_FLATS, 9)]),
    (HEXAGON, {}, {"G01 X17.": "G01 X16.74"}, []),
    (HEXAGON, {}, {"G01 X17.": "G01 X17.002"}, [(Kind.ACROSS_FLATS, 9)]),
    (HEXAGON, {"tip_radius_mm = 40.0": "tip_radius_mm = 2.5"}, {}, [(Kind.CONVEX, 6)]),
    (SPUR, {}, {"T20 L1": "T21 L1"}, [(Kind.TEETH, 6)]),
    (SPUR, {}, {"T20 L1": "T20 L2"}, [(Kind.STARTS, 6)]),
    (SPUR, {}, {"T20 L1": "T30 L2"}, [(Kind.TEETH, 6), (Kind.STARTS, 6)]),
    (SPUR, {"gashes = 12\n": 'gashes = 12\nhand = "left"\n'}, {}, [(Kind.HAND_OF_HOB, 6)]),
    (SPUR, {}, {"T20 L1": "T20 L1 Q2. P20."}, [(Kind.HELIX_UNWANTED, 6)]),
    (HELICAL, {}, {"L1 Q2. P20.": "L1"}, [(Kind.HELIX_MISSING, 6)]),
    (HELICAL, {}, {"P20.": "P-20."}, [(Kind.HAND_OF_GEAR, 6)]),
    (HELICAL, {}, {"P20.": "P20.5"}, [(Kind.HELIX_ANGLE, 6)]),
    (HELICAL, {}, {"Q2.": "Q2.5"}, [(Kind.MODULE, 6)]),
    (SPUR, {"gashes = 12": "gashes = 12\nswivel_deg = 1.7634"}, {}, [(Kind.SWIVEL, 6)]),
    (SPUR, {"gashes = 12": "gashes = 2"}, {}, [(Kind.GENERATING_FLATS, 6)]),
    (SPUR, {}, {"F2. ;        one": "F4. ;        one"}, [(Kind.FEED_MARKS, 9)]),
    (SPUR, {}, {"S300": "S1500"}, [(Kind.CUTTING_SPEED, 9)]),
    (SPUR, {}, {"X35.": "X35.4"}, [(Kind.DEPTH, 9)]),
    (SPUR, {}, {"X35.": "X34.6"}, [(Kind.DEPTH, 9)]),
    (SPUR, {}, {"X35.": "X45."}, [(Kind.NOTHING_CUT, 6)]),
    (SPUR, {}, {"Z20.": "Z-5."}, [(Kind.FACE_NOT_COVERED, 8)]),
    (SPUR, {}, {"N0060 G01": "N0060 G00"}, [(Kind.RAPID, 9)]),
    (SPUR, {}, {"N0060": "N0055 S-300\nN0060"}, []),
    (SPUR, {}, {"N0100": "G01 Z-30.\nS-300\nN0100"}, [(Kind.REVERSED, 11)]),
]


@pytest.mark.parametrize(("scene", "job", "program", "expected"), ONE)
def test_one_thing_wrong_is_said_at_its_block_and_nothing_else(advise, scene, job, program, expected):
    found = advise(scene, job=job, program=program)
    assert [(a.kind, a.span.line if a.span else None) for a in found] == expected
    for one in found:
        assert one.found
        assert one.remedy
        assert str(one).startswith(
            f"{one.span}: {one.weight.value}[{one.kind.value}]: {KINDS[one.kind].text}"
        )


def test_bow_is_said_in_micrometres_with_the_caliper(scenes, advice_of):
    """geometry.md, section 3: P2 Q6 on R 40: 82.97 µm concave; a caliper reads S + 2 · bow."""
    (concave,) = advice_of(scenes / "hexagon_af17_original")
    assert concave.value == pytest.approx(-82.97, abs=0.005)
    assert "82.97 µm" in concave.found
    assert "17.166 mm" in concave.found
    assert "3 insert" in concave.remedy


def test_the_hob_must_be_that_of_the_gear(advise):
    """Module and pressure angle stand in the job: no place in the program."""
    found = advise(SPUR, job={"gashes = 12": "gashes = 12\npressure_angle_deg = 15.0"})
    assert [(a.kind, a.span) for a in found] == [(Kind.HOB, None)]
    assert "15 °" in found[0].found


@pytest.mark.parametrize(
    ("scene", "old", "new", "words"),
    [
        (
            SPUR,
            'kind = "hob"\nnormal_module_mm = 2.0\noutside_diameter_mm = 70.0\ngashes = 12',
            'kind = "polygon_head"\ninserts = 3\ntip_radius_mm = 35.0',
            "hobbing with a polygon head",
        ),
        (
            SPUR,
            'kind = "gear"\nnumber_of_teeth = 20\nnormal_module_mm = 2.0\naccuracy_class = 8',
            'kind = "polygon"\nnumber_of_sides = 6\nacross_flats_mm = 35.0',
            "hobbing, where the nominal is a polygon",
        ),
    ],
)
def test_the_tool_must_be_that_of_the_gear_box_and_of_the_part(advise, scene, old, new, words):
    job = {old: new}
    if "polygon_head" not in new:
        job["gashes = 12"] = "gashes = 12\nswivel_deg = -1.7631"  # without a nominal gear it must be given
    found = advise(scene, job=job)
    assert [(a.kind, a.span.line if a.span else None) for a in found] == [(Kind.TOOL, 6)]
    assert words in found[0].found


def test_a_tool_that_the_job_does_not_have(advise):
    """A job of numbered tools: T03 stops a run, so a check says it."""
    found = advise(HEXAGON, job={"[tool]": "[tools.1]"}, program={"N0010": "T0101\nN0010"})
    assert found == []
    two = {"[tool]": '[tools.2]\nkind = "polygon_head"\ninserts = 2\ntip_radius_mm = 40.0\n[tools.1]'}
    found = advise(HEXAGON, job=two, program={"N0010": "T0303\nN0010"})
    assert [(a.kind, a.span.line if a.span else None) for a in found] == [(Kind.UNKNOWN_TOOL, 3)]
    assert "T01" in found[0].remedy


def test_the_tool_in_the_spindle_is_the_one_that_counts(advise):
    """Two heads, two and three inserts: the T word decides which of them P is compared with."""
    two = {"[tool]": '[tools.2]\nkind = "polygon_head"\ninserts = 2\ntip_radius_mm = 40.0\n[tools.1]'}
    assert advise(HEXAGON, job=two, program={"N0010": "T0101\nN0010"}) == []
    found = advise(HEXAGON, job=two, program={"N0010": "T0202\nN0010"})
    assert [a.kind for a in found] == [Kind.INSERTS, Kind.SIDES]


def test_feeding_with_the_tool_at_rest(advise):
    """G98 does not wait for a spindle: the tool goes into the stock without turning."""
    found = advise(
        SPUR,
        program={"N0040 S300 ": "N0040 ", "G99 G01 X35. F2.": "G98 G01 X35. F60.", "Z-38. F2.": "Z-38. F60."},
    )
    kinds = [(a.kind, a.span.line if a.span else None) for a in found]
    assert (Kind.STANDSTILL, 9) in kinds
    assert not {Kind.RAPID, Kind.OUT_OF_SYNC} & {kind for kind, _ in kinds}


def test_feeding_without_gear_box(advise):
    found = advise(
        SPUR,
        program={
            G81: "N0030 ;",
            "N0040 S300": "N0040 M03 S300",
            "N0110 S0": "N0110 M05",
            "N0120 G80 ;": "N0120 ;",
        },
    )
    assert [(a.kind, a.span.line if a.span else None) for a in found] == [(Kind.OUT_OF_SYNC, 9)]


def test_the_gear_box_let_go_inside_the_part(advise):
    found = advise(
        SPUR,
        program={
            "N0100": "G01 Z-30.\nG80\nG98 G01 X50. F500.\nG99\nN0100",
            "N0100 G01 X50. F2. ;": "N0100 ;",
        },
    )
    kinds = {(a.kind, a.span.line if a.span else None) for a in found}
    assert (Kind.RELEASED, 11) in kinds


@pytest.mark.parametrize(
    ("again", "place", "expected"),
    [
        ("G81 T21 L1\nG81 T20 L1", "N0060", [(Kind.CHANGED_TURNING, 9), (Kind.CHANGED_TURNING, 10)]),
        ("G81 T20 L1", "N0060", []),
        ("G81 T20 L1 Q2. P0.", "N0060", []),
        ("G81 T20 L1 Q2. P1.\nG81 T20 L1", "N0060", []),
        ("G01 Z-30.\nG81 T20 L1 Q2. P1.", "N0100", [(Kind.CHANGED_TURNING, 11)]),
    ],
)
def test_gear_box_changed_while_turning(advise, again, place, expected):
    """Another ratio always; another compensation only inside the part, where the lead would change."""
    found = advise(SPUR, job=SYNC_201_4, program={place: f"{again}\n{place}"})
    changed = [a for a in found if a.kind is Kind.CHANGED_TURNING]
    assert [(a.kind, a.span.line if a.span else None) for a in changed] == expected


def test_only_the_gear_box_that_cuts_is_judged(advise):
    """A gear box engaged anew before it has cut is not judged; the one that cuts is."""
    found = advise(HELICAL, job=SYNC_201_4, program={G81_HELICAL: f"G81 T20 L1\n{G81_HELICAL}"})
    assert found == []
    found = advise(HELICAL, job=SYNC_201_4, program={G81_HELICAL: f"{G81_HELICAL}\nG81 T20 L1 ;"})
    assert [(a.kind, a.span.line if a.span else None) for a in found] == [(Kind.HELIX_MISSING, 7)]


def test_a_gear_box_that_never_cuts_is_judged_when_it_is_released(advise):
    """Rulings, section 3: P is compared with the mounted tool."""
    found = advise(HEXAGON, program={"G01 X17. F1.": "G01 X25. F1.", "P3 Q6": "P2 Q4"})
    assert [a.kind for a in found] == [Kind.INSERTS, Kind.NOTHING_CUT]


def test_roughing_feed_is_no_matter_where_a_finishing_pass_follows(advise):
    """Two passes: coarse at X35.6, fine at full depth; and the other way round."""
    passes = "G01 X{0} F2.\nG01 Z-38. F{1}\nG01 X50. F6.\nG00 Z20.\nG01 X{2} F2.\nN0060 G01 Z-38. F{3} ;"
    body = {"N0050 G99 G01 X35. F2. ;": "N0050 G99 ;", CUT: passes.format("35.6", "4.", "35.", "2.")}
    assert advise(SPUR, program=body) == []
    body[CUT] = passes.format("35.6", "2.", "35.", "4.")
    found = advise(SPUR, program=body)
    assert [a.kind for a in found] == [Kind.FEED_MARKS]
    # δ_x = f² sin α_n / (8 ρ), ρ = d_0 / 2 = 32.5 mm
    assert found[0].value == pytest.approx(1000.0 * 16.0 * math.sin(math.radians(20.0)) / 260.0, rel=1e-9)


def test_the_threshold_of_feed_marks_is_half_of_the_helix_form_tolerance(advise):
    """inspection.md, section 1: f_fβ of class 8; the remedy names the feed that just keeps to it."""
    size = GearSize(
        number_of_teeth=20, reference_diameter=40.0, normal_module=2.0, face_width=20.0, helix_angle=0.0
    )
    half = gear_tolerance("helix_form", size, 8) / 2.0
    feed = math.sqrt(half * 260.0 / 1000.0 / math.sin(math.radians(20.0)))
    for factor, expected in ((0.99, []), (1.01, [Kind.FEED_MARKS])):
        found = advise(SPUR, program={"Z-38. F2.": f"Z-38. F{feed * factor:.4f}"})
        assert [a.kind for a in found] == expected
    assert f"{feed:.2f} mm per turn" in found[0].remedy
    assert f"class {8}" in found[0].found


def test_per_minute_feed_counts_by_the_turns_of_the_work(advise):
    """300 rpm / 20 teeth = 15 rpm of the work: 60 mm/min are 4 mm a turn."""
    found = advise(SPUR, program={"G01 Z-38. F2.": "G98 G01 Z-38. F60.", "N0100 G01": "N0100 G99 G01"})
    assert [a.kind for a in found] == [Kind.FEED_MARKS]
    assert "4.000 mm per turn" in found[0].found


@pytest.mark.parametrize(
    ("move", "expected"),
    [
        ("G00 X43.9 Z-10.", [Kind.RAPID]),
        ("G00 X44. Z-10.", []),
        ("G00 X44.1 Z-10.", []),
        ("G28 U-8. W-25.", [Kind.RAPID]),
        ("G53 X-358. Z-310.", [Kind.RAPID]),
        ("G00 X30. Z40.", []),
    ],
)
def test_rapid_into_the_blank(advise, move, expected):
    """The tip's diameter counts: X44. touches the blank of 44 mm; at Z40. the hob of 70 mm is beside it."""
    found = advise(
        SPUR, program={"N0025 G54 G00 X50. Z20. ;": f"G54 G00 X50. Z20.\n{move}\nG00 X60.\nG00 Z20.\nX50. ;"}
    )
    assert [a.kind for a in found] == expected


def test_the_end_of_the_blank_counts_with_the_circle_of_the_hob(advise):
    """At X35. the hob of 70 mm clears the front of a blank of 44 mm from Z √(35² − 30.5²) = 17.17."""
    edge = math.sqrt(35.0**2 - (35.0 + 17.5 - 22.0) ** 2)
    for z, expected in ((edge + 0.05, []), (edge - 0.4, [Kind.RAPID])):
        start = {"G00 X50. Z20.": f"G00 X50. Z{z:.3f}", "G99 G01 X35. F2. ;": "G99 G00 X35. ;"}
        assert [a.kind for a in advise(SPUR, program=start)] == expected


def test_rapid_back_through_what_is_cut_already_is_no_collision(advise):
    found = advise(SPUR, program={"N0100 G01 X50. F2. ;": "G00 Z20.\nN0100 G00 X50. ;"})
    assert found == []


def test_a_program_that_ends_in_an_alarm_is_not_judged_by_what_it_leaves(advise):
    assert advise(SPUR, program={"N0060 G01": "G999\nN0060 G01"}, alarms=1) == []


def test_a_subprogram_says_a_thing_once(advise):
    found = advise(
        SPUR,
        program={
            "N0060 G01 Z-38. F2. ;        one": "M98 P77 L3 ;",
            "N0130 M30 ;": "N0130 M30 ;\nO0077\nG00 Z-38.\nG01 X50. F2.\nG00 Z20.\nG01 X35. F2.\nM99",
        },
    )
    assert [a.kind for a in found].count(Kind.RAPID) == 1


def test_every_kind_has_its_row():
    """Numbers are stable, rows complete; what is only a note says so."""
    assert list(KINDS) == list(Kind)
    assert [kind.value for kind in Kind] == sorted({kind.value for kind in Kind})
    for kind, row in KINDS.items():
        assert row.kind is kind
        assert kind.value.startswith("HT92")
        assert row.text == row.text.upper()
        assert row.remedy
        assert row.clause
    assert {kind for kind, row in KINDS.items() if row.weight is Weight.NOTE} == {Kind.CUTTING_SPEED}
