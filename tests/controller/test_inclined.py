"""Rulings, section 4: the worked cases of the inclined-axis original, the order of references, sync with
it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from controller.laws.inclined import InclinedPair

ON = {"8200#0": 1, "1006#3.X": 0}
HOME = "G28 Y0\nG28 X0\n"


@given(st.floats(-84.0, 84.0), st.floats(-500, 500), st.floats(-500, 500))
def test_law_and_inverse(angle: float, x: float, y: float) -> None:
    """Ya = Yp / cos θ, Xa = Xp − Yp tan θ; inverse Yp = Ya cos θ, Xp = Xa + Yp tan θ; the slant is (sin θ,
    cos θ)."""
    pair = InclinedPair(inclined=2, orthogonal=0, angle=angle)
    slides = pair.to_slides(x, y)
    theta = np.radians(angle)
    assert slides == pytest.approx((x - y * np.tan(theta), y / np.cos(theta)), abs=1e-9)
    assert pair.to_slides(x, y, compensated=False) == pytest.approx((x, y / np.cos(theta)), abs=1e-9)
    assert pair.to_cartesian(*slides) == pytest.approx((x, y), abs=1e-9)
    assert pair.to_cartesian(0.0, 1.0) == pytest.approx((np.sin(theta), np.cos(theta)))


CASES = [
    ("G00 Y100.", {}, {}, (0, 100), (57.735, 115.470)),
    ("G00 Y100.\nG00 X200.", {}, {}, (200, 100), (257.735, 115.470)),
    ("G01 X200. Y100. F1000", {}, {}, (200, 100), (257.735, 115.470)),
    ("G00 Y100.", {}, {"NOZAGC": True}, (0, 100), (0, 115.470)),
    ("G00 Y100.\nG00 X200.", {}, {"NOZAGC": True}, (200, 100), (200, 115.470)),
    ("G53 Y100.", {}, {}, (-50, 86.603), (0, 100)),
    ("G53 Y100.\nG53 X200.", {}, {}, (150, 86.603), (200, 100)),
    ("G53 Y100.", {}, {"NOZAGC": True}, (-50, 86.603), (0, 100)),
    ("G00 X200. Y100.\nG28 X200.", {"8209#0": 1}, {}, (0, 100), (57.735, 115.470)),
    ("G00 X200. Y100.\nG28 X200.", {"8209#0": 0}, {}, (-57.735, 100), (0, 115.470)),
    ("G00 X200. Y100.\nG28 X200.\nG28 Y100.", {"8209#0": 1}, {}, (0, 0), (0, 0)),
    ("G00 X200. Y100.\nG28 X200.\nG28 Y100.", {"8209#0": 0}, {}, (0, 0), (0, 0)),
]


@pytest.mark.parametrize("case", CASES)
def test_worked_cases(run, case) -> None:
    """All to 0.001, θ = −30°, C = 1 (both axes in radius)."""
    blocks, parameters, signals, absolute, machine = case
    result = run(f"{HOME}{blocks}\nM30", "tilted", ON | parameters, signals=signals)
    assert result.alarms == ()
    assert (result.absolute["X"], result.absolute["Y"]) == pytest.approx(absolute, abs=1e-3)
    assert (result.machine["X"], result.machine["Y"]) == pytest.approx(machine, abs=1e-3)


def test_diameter_axis_has_c_2(run) -> None:
    """C = 2 where the orthogonal axis counts in diameter: Xa = 0 − 2 · 100 · tan(−30°) = 115.470."""
    result = run(f"{HOME}G00 Y100.\nM30", "tilted", {"8200#0": 1})
    assert (result.absolute["X"], result.machine["X"]) == (0.0, pytest.approx(115.470, abs=1e-3))


def test_components_of_speed(drive) -> None:
    """Fay = Fpy / cos θ, Fax = −Fpy tan θ: pure Y at 100 mm/min runs X at 57.7, not at 157.7."""
    driven = drive(f"{HOME}G01 Y10. F100\nM30", "tilted", parameters=ON)
    x, y = (np.diff(driven.axis(letter)).max() * 60_000 for letter in "XY")
    assert (x, y) == (pytest.approx(57.735, abs=1e-3), pytest.approx(115.470, abs=1e-3))


def test_slowed_by_the_slide_that_would_be_too_fast(run) -> None:
    """An axis that would exceed its own limit is slowed, path kept, and reported."""
    result = run(f"{HOME}G01 Y100. F1000\nM30", "tilted", ON | {"1430.X": 100})
    (warning,) = result.warnings
    assert warning.number == "HT9107"
    assert "173 possible" in warning.found
    assert result.machine["X"] == pytest.approx(57.735, abs=1e-3)


@pytest.mark.parametrize(
    ("blocks", "number"),
    [
        ("G28 X0", "DS0020"),
        ("G28 X0 Y0", "DS0020"),
        ("G28 Y0\nG28 X0 Y0", "DS0020"),
        ("G00 X10.", "PS0224"),
        ("G53 Y10.", "PS0224"),
        ("G28 Y0\nG01 X10. F100", "PS0224"),
        ("G28 Y0\nG28 X0\nG28 X0\nG28 Y0\nG28 X0 Y0\nG00 X1.", None),
        ("G00 Z10.", None),
        ("G28 W0", None),
    ],
)
def test_order_of_references(alarm_of, blocks: str, number: str | None) -> None:
    """Inclined before orthogonal, not both in one block, after power-on; established, in any order; PS0224
    before."""
    assert alarm_of(f"{blocks}\nM30", "tilted", ON) == number


def test_hobbing_example_alarms_where_x_and_z_are_the_pair(alarm_of) -> None:
    """The hobbing example's G28 U0 W0 alarms on a machine whose inclined pair is X/Z: correct."""
    pair = {"8200#0": 1, "8210": 20000, "8211": 1, "8212": 2}
    assert alarm_of("N0010 G28 U0 W0\nM30", "hobbing", pair) == "DS0020"


def test_nozagc_loses_the_references(run) -> None:
    """After the inclined axis has moved with NOZAGC = 1 both references are lost (warning); the order rule
    applies
    again, and the returns make the displays true."""
    result = run(f"{HOME}G00 Y100.\nG28 X0\nM30", "tilted", ON, signals={"NOZAGC": True})
    assert [w.number for w in result.warnings] == ["HT9108"]
    assert [a.number for a in result.alarms] == ["DS0020"]
    result = run(f"{HOME}G00 Y100.\nG28 V0\nG28 U0\nM30", "tilted", ON, signals={"NOZAGC": True})
    assert result.alarms == ()
    assert (result.absolute["X"], result.absolute["Y"], result.machine["X"]) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(("angle", "off"), [(85000, True), (-95000, True), (90000, True), (84999, False)])
def test_dead_band_switches_off(run, angle: int, off: bool) -> None:
    """8210 at ±(85..95) disables the function (warning)."""
    result = run("M30", "tilted", ON | {"8210": angle})
    assert [w.number for w in result.warnings] == (["HT9111"] if off else [])


def test_hobbing_is_allowed_and_noted(run) -> None:
    """G81 with it is allowed and notes that the originals are silent."""
    result = run(f"{HOME}G81 T20 L1\nG80\nM30", "tilted", ON)
    assert result.alarms == ()
    assert [w.number for w in result.warnings] == ["HT9112"]


def test_axial_travel_is_cartesian(run) -> None:
    """The metal sees Cartesian Z: with Z inclined by θ to X, ΔZ is what the program says."""
    pair = {"8200#0": 1, "8210": 20000, "8211": 2, "8212": 1}
    text = "G28 W0\nG28 U0\nG81 T20 Q2. P20.\nG01 Z-20. F500\nG80\nM30"
    result = run(text, "hobbing", pair)
    plain = run(text, "hobbing")
    assert result.alarms == plain.alarms == ()
    assert result.machine["C"] == pytest.approx(plain.machine["C"], abs=1e-6)
    assert result.machine["Z"] != pytest.approx(plain.machine["Z"], abs=0.1)


@pytest.mark.parametrize(("cartesian", "frame"), [(0, "slide Y"), (1, "Cartesian Y")])
def test_stroke_limit_on_slides_or_cartesian(run, cartesian: int, frame: str) -> None:
    """Stored stroke limits on the slides by default; 8201#0 = 1 checks Cartesian. The slide that stops is
    named."""
    limits = ON | {"8201#0": cartesian, "1320.Y": 110.0, "1300#7": 1}
    result = run(f"{HOME}G01 Y200. F1000\nM30", "tilted", limits)
    assert result.alarms[0].number == "OT0500"
    assert frame in result.alarms[0].found
    expected = 110.0 if cartesian else 110.0 * np.cos(np.radians(30))
    assert result.absolute["Y"] == pytest.approx(expected, abs=1e-6)
