"""Each fault alone on rigid axes, read on the flanks as cut, against its closed form (geometry.md 5).

Fine feeds on short faces: what a perfect machine leaves there is below 0.1 µm but for the hob's own flats.
"""

import math

import numpy as np
import pytest

from twin.faults.encoders import CyclicError

ALPHA = math.radians(20.0)
SIDES = np.array([[1], [-1]])


def index_errors(gear):
    """(2, z) displacement of left and right flanks [µm] at mid-depth, in the sense of numbering."""
    teeth = np.arange(gear.gear.teeth)
    deviation = gear.deviation(teeth, SIDES, gear.gear.measuring_diameter / 2, -gear.length / 2)
    return -SIDES * deviation / math.cos(gear.gear.transverse_pressure)


def profile(gear, tooth, low, high, points=240):
    """Roll lengths (m,) and deviations (2, m) [µm] of a tooth's left and right profile between diameters."""
    roll = np.linspace(gear.gear.roll_length(low), gear.gear.roll_length(high), points)
    return roll, gear.deviation(tooth, SIDES, gear.gear.radius_at(roll), -gear.length / 2)


def helix_slopes(gear, teeth, reference=None, points=60):
    """(2, teeth) rise of left and right flanks [µm] from the lower to the upper end of the face."""
    z = np.linspace(-gear.length, 0.0, points)
    at = np.asarray(teeth)[:, None]
    rise = []
    for side in (1, -1):
        values = gear.deviation(at, side, gear.gear.measuring_diameter / 2, z)
        if reference is not None:
            values = values - reference.deviation(at, side, gear.gear.measuring_diameter / 2, z)
        rise.append(np.polyfit(z, values.T, 1)[0] * gear.length)
    return np.array(rise)


@pytest.fixture(scope="module")
def ideal(hobbed):
    """A short gear without fault: m2 z20."""
    return hobbed(length=0.4, feed=0.2)


def test_without_fault_there_is_nothing_to_read(hobbed):
    gear = hobbed(teeth=40, length=0.4, feed=0.2)
    assert np.abs(index_errors(gear)).max() < 0.08


def test_eccentric_work(hobbed):
    """e 20 µm, m2 z40: F_p = 2e/cos α_t = 42.57 µm, largest f_p = 2e sin(π/z)/cos α_t = 3.34 µm."""
    phase = 40.0
    gear = hobbed(
        f"work_eccentricity_mm = 0.02\nwork_eccentricity_phase_deg = {phase}", teeth=40, length=0.4, feed=0.2
    )
    index = index_errors(gear)
    np.testing.assert_allclose(np.ptp(index, axis=1), 42.57, atol=0.1)
    steps = np.diff(index, axis=1, append=index[:, :1])
    np.testing.assert_allclose(np.abs(steps).max(axis=1), 3.34, atol=0.03)
    # in the part's frame everything cut stands about the spindle's axis, at −e
    towards = np.array([math.cos(math.radians(phase)), math.sin(math.radians(phase)), 0.0])
    for row, side in enumerate((1, -1)):
        _, outward = gear.nominal(np.arange(40), side, np.full(40, 40.0), np.full(40, -0.2))
        found = -side * index[row] * math.cos(ALPHA)
        np.testing.assert_allclose(found, -20.0 * outward @ towards, atol=0.1)


@pytest.mark.parametrize("helix", [0.0, 20.0])
def test_tilted_work(hobbed, helix):
    """f_Hβ varies once per turn over the teeth with amplitude L_β tan τ; on a helical gear the tilt moves the
    flanks along the axis, too, r τ tan β in the transverse plane: L_β tan τ / cos² β, where L_β is short."""
    length, tilt, phase = 2.0, 0.1, 25.0
    settings = {"helix": helix, "length": length, "feed": 0.2}
    gear = hobbed(f"work_tilt_deg = {tilt}\nwork_tilt_phase_deg = {phase}", **settings)
    teeth = np.arange(0, 20, 2)
    rise = helix_slopes(gear, teeth, hobbed(**settings))
    # the blank's front end leans to `phase`: what is cut there stands off to the other side
    towards = np.array([math.cos(math.radians(phase)), math.sin(math.radians(phase)), 0.0])
    about = np.cross([0.0, 0.0, 1.0], towards) * math.tan(math.radians(tilt))
    z = np.linspace(-length, 0.0, 21)
    radius = np.full(len(z), gear.gear.measuring_diameter / 2)
    expected = np.zeros((2, len(teeth)))
    for row, side in enumerate((1, -1)):
        for k, tooth in enumerate(teeth):
            points, tangent = gear.nominal(tooth, side, radius, z)
            moved = -1e3 * np.cross(about, points + np.array([0.0, 0.0, length / 2]))
            # normal to the flank, as long as its part in the transverse plane is 1
            normal = tangent - side * gear.gear.base_radius * gear.gear.twist * np.array([0.0, 0.0, 1.0])
            expected[row, k] = np.polyfit(z, (moved * normal).sum(axis=1), 1)[0] * length
    np.testing.assert_allclose(rise, expected, atol=0.07)
    amplitude = 1e3 * length * math.tan(math.radians(tilt)) / math.cos(math.radians(helix)) ** 2
    once_per_turn = 2.0 * np.abs(np.fft.fft(rise, axis=1)[:, 1]) / len(teeth)
    np.testing.assert_allclose(once_per_turn, amplitude, rtol=0.02)


@pytest.mark.parametrize(("column", "order", "per_turn"), [(3, 1, 1), (3, 5, 5), (2, 1, 20)])
def test_cyclic_encoder_error(hobbed, column, order, per_turn):
    """A rad, n per gear turn: a pitch wave r·A of order n; 1″ = 0.24 µm at d 100."""
    amplitude = 20.0
    gear = hobbed(
        teeth=20,
        length=0.4,
        feed=0.2,
        encoders={column: CyclicError(amplitude_arcsec=amplitude, order=order)},
    )
    angle = math.radians(amplitude / 3600.0)
    if column == 2:
        # the hob's wave comes once a tooth: all teeth alike, the flanks shifted by their place in it
        index = index_errors(gear)
        assert np.ptp(index, axis=1).max() < 0.1
        return
    index = index_errors(gear)
    wave = 1e3 * 20.0 * angle
    assert wave == pytest.approx(20.0 * 0.24 * 0.4, rel=0.02)
    spectrum = np.fft.rfft(index, axis=1) * 2 / 20
    np.testing.assert_allclose(np.abs(spectrum[:, per_turn]), wave, rtol=0.02)
    others = np.delete(np.abs(spectrum), [0, per_turn], axis=1)
    assert others.max() < 0.05


def test_hob_runout(hobbed):
    """A wave on the profile ± e_h sin α_n of one base pitch, on a hob with edges enough to show it."""
    runout = 0.005
    gear, even = (
        hobbed(f"hob_runout_mm = {e}", length=0.4, feed=0.2, gashes=48, step_deg=3.0) for e in (runout, 0.0)
    )
    roll, deviation = profile(gear, 3, 38.2, 43.5)
    _, plain = profile(even, 3, 38.2, 43.5)
    pitch = 2 * math.pi * gear.gear.base_radius / 20
    turn = 2 * math.pi * roll / pitch
    design = np.column_stack([np.ones_like(turn), np.cos(turn), np.sin(turn)])
    for side in range(2):
        fit, *_ = np.linalg.lstsq(design, deviation[side] - plain[side], rcond=None)
        assert np.hypot(fit[1], fit[2]) == pytest.approx(1e3 * runout * math.sin(ALPHA), rel=0.02)
        assert np.ptp(deviation[side] - plain[side] - design @ fit) < 0.2


def test_gash_error(hobbed, ideal):
    """One gash's flats deeper by p_x cos α_n δ/360, once per base pitch."""
    errors = [0.0] * 12
    errors[4] = 0.1
    gear = hobbed(f"hob_gash_error_deg = {errors}", length=0.4, feed=0.2)
    deep = math.pi * 2.0 / math.cos(math.asin(2.0 / 65.0)) * math.cos(ALPHA) * 0.1 / 360.0 * 1e3
    assert deep == pytest.approx(1.64, abs=0.01)
    found = []
    for side in range(2):
        change = (profile(gear, 3, 38.2, 43.5, 600)[1] - profile(ideal, 3, 38.2, 43.5, 600)[1])[side]
        found.append((change.min(), change.max()))
    # ahead: on one flank the gash cuts as much deeper as it leaves on the other, its neighbours being further
    (deepest, nothing), (never, left) = sorted(found)
    assert deepest == pytest.approx(-deep, rel=0.02)
    assert left == pytest.approx(deep, rel=0.02)
    assert max(nothing, -never) < 0.02


@pytest.mark.parametrize("helix", [0.0, 20.0])
def test_hob_lead_error(hobbed, helix):
    """f_Hα ≈ E cos α_n · L_α/p_b: first order in E.

    In the plane across the axis a deviation is 1/cos β_b of the normal one, and so is a way along the path of
    contact, on which one turn of the hob is p_bn: together 1/cos² β_b on a helical gear.
    """
    error = 10.0
    settings = {"helix": helix, "length": 0.4, "feed": 0.2}
    gear, even = hobbed(f"hob_lead_error_um_per_turn = {error}", **settings), hobbed(**settings)
    low, high = gear.gear.reference_diameter - 1.8, gear.gear.reference_diameter + 3.5
    roll, deviation = profile(gear, 3, low, high)
    _, plain = profile(even, 3, low, high)
    base_pitch = math.pi * 2.0 * math.cos(ALPHA)
    inclined = math.sin(math.radians(helix)) * math.cos(ALPHA)  # sin β_b
    expected = error * math.cos(ALPHA) * (roll[-1] - roll[0]) / base_pitch / (1.0 - inclined**2)
    for side in range(2):
        slope = np.polyfit(roll, deviation[side] - plain[side], 1)[0] * (roll[-1] - roll[0])
        assert slope == pytest.approx(expected, rel=0.02)


@pytest.mark.parametrize("error", [2.0, -3.0])
def test_swivel_error_widens_the_gap(hobbed, ideal, error):
    """Per flank and normal to it about d_0 tan²δ cos α_n/(4 tan α_n)."""
    gear = hobbed(f"swivel_error_deg = {error}", length=0.4, feed=0.2, over=7.0)
    change = [g.deviation(np.arange(0, 20, 5), SIDES, 20.0, -0.2).mean() for g in (ideal, gear)]
    expected = 1e3 * 65.0 * math.tan(math.radians(error)) ** 2 * math.cos(ALPHA) / (4 * math.tan(ALPHA))
    assert change[0] - change[1] == pytest.approx(expected, rel=0.05)


def test_x_drift(hobbed):
    """f_Hβ ≈ v_x (L_β/v_z) sin α_t: a taper, material alike on both flanks."""
    length, drift = 2.0, 30.0
    gear = hobbed(f"x_drift_um_per_min = {drift}", length=length, feed=0.2)
    plain = hobbed(length=length, feed=0.2)
    # the hob goes down to −Z at 300/20 turns of 0.2 mm a minute, and stands further off at the lower end
    expected = -drift * length / (300 / 20 * 0.2) * math.sin(ALPHA)
    rise = helix_slopes(gear, [0, 7], plain)
    np.testing.assert_allclose(rise, expected, rtol=0.02)


@pytest.mark.parametrize("plane", ["xz", "yz"])
@pytest.mark.parametrize("helix", [0.0, 15.0])
def test_slide_tilt(hobbed, plane, helix):
    """In X-Z L_β tan ψ sin α_t alike on both flanks, in Y-Z L_β tan ψ cos α_t opposite."""
    length, tilt = 2.0, 0.1
    settings = {"helix": helix, "length": length, "feed": 0.2}
    gear = hobbed(f"slide_tilt_deg = {{{plane} = {tilt}}}", **settings)
    plain = hobbed(**settings)
    rise = helix_slopes(gear, [0, 7], plain)
    size = 1e3 * length * math.tan(math.radians(tilt))
    if plane == "xz":
        expected = size * math.sin(gear.gear.transverse_pressure) * np.ones((2, 1))
    else:
        # cut at +X, the teeth lean to +Y with the tool as z rises: to +angle, material on left flanks
        expected = size * math.cos(gear.gear.transverse_pressure) * SIDES
    np.testing.assert_allclose(rise, np.broadcast_to(expected, rise.shape), rtol=0.02)
