import pytest

from twin.errors import InputError
from twin.inspection.tolerances import (
    ITEMS,
    GearSize,
    across_flats_limits,
    class_reached,
    flatness_limits_um,
    gear_tolerance,
    outside_standard,
)

# the table of inspection.md, section 1
ORDER = (
    "single_pitch", "cumulative_pitch", "profile_slope", "profile_form", "profile_total",
    "helix_slope", "helix_form", "helix_total", "runout",
)  # fmt: skip
TABLE = [
    (3, 120, 30, 6, (9.0, 29, 7.5, 9.5, 12, 9.0, 10, 14, 26)),
    (2, 40, 20, 6, (8.5, 24, 7.0, 8.5, 11, 8.5, 9.0, 12, 22)),
]


def size(module=2.0, d=40.0, width=20.0, teeth=20, helix=0.0):
    return GearSize(
        number_of_teeth=teeth, reference_diameter=d, normal_module=module, face_width=width, helix_angle=helix
    )


@pytest.mark.parametrize(("module", "d", "width", "accuracy_class", "expected"), TABLE)
def test_printed_table(module, d, width, accuracy_class, expected):
    assert set(ORDER) == set(ITEMS)
    gear = size(module, d, width, round(d / module))
    assert tuple(gear_tolerance(item, gear, accuracy_class) for item in ORDER) == expected


@pytest.mark.parametrize("item", ITEMS)
def test_class_reached_is_the_finest_that_holds(item):
    gear = size()
    for a in range(1, 12):
        limit = gear_tolerance(item, gear, a)
        assert class_reached(item, gear, limit) == a
        assert class_reached(item, gear, -limit) == a
        assert class_reached(item, gear, limit + 1e-6) == (a + 1 if a < 11 else None)


def test_two_classes_double_the_tolerance_up_to_rounding():
    for item in ITEMS:
        for a in range(1, 10):
            fine, coarse = (gear_tolerance(item, size(), a + k) for k in (0, 2))
            assert coarse == pytest.approx(2 * fine, abs=1.1)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"teeth": 4}, "number of teeth 4"),
        ({"module": 0.4}, "normal module 0.4 mm"),
        ({"width": 3.9}, "face width 3.9 mm"),
        ({"helix": -46.0}, "helix angle 46°"),
        ({"d": 4.9}, "reference diameter 4.9 mm"),
    ],
)
def test_outside_the_standard_is_said(change, words):
    (sentence,) = outside_standard(size(**change))
    assert sentence.startswith(words)
    assert outside_standard(size()) == []


@pytest.mark.parametrize(
    ("nominal", "tolerance", "low"),
    [(17, "h13", 16.73), (10, "h13", 9.78), (10.001, "h13", 9.731), (36, "h14", 35.38)],
)
def test_across_flats(nominal, tolerance, low):
    assert across_flats_limits(nominal, tolerance) == (pytest.approx(low), nominal)


def test_unknown_tolerance_names_the_known():
    with pytest.raises(InputError, match="known are h13, h14"):
        across_flats_limits(17, "h7")
    with pytest.raises(InputError, match="valid is above 0 up to 120 mm"):
        across_flats_limits(121, "h13")


@pytest.mark.parametrize(
    ("length", "limits"),
    [
        # ISO 2768-2, table 1
        (10.0, {"H": 20, "K": 50, "L": 100}),
        (10.01, {"H": 50, "K": 100, "L": 200}),
        (20.0, {"H": 50, "K": 100, "L": 200}),
        (100.0, {"H": 100, "K": 200, "L": 400}),
        (3000.0, {"H": 400, "K": 800, "L": 1600}),
        (3001.0, {}),
    ],
)
def test_general_tolerances_on_flatness(length, limits):
    assert flatness_limits_um(length) == limits
