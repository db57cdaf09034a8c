"""Rulings, section 4: reference states, their order, their loss, and the manual return by AZR."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from controller.laws.inclined import InclinedPair, manual_return
from controller.motion.reference import Reference, References
from controller.tables.alarms import AlarmError

PAIR = InclinedPair(inclined=2, orthogonal=0, angle=-30.0)
X, Z, Y = 0, 1, 2


def found(action, *args, **options) -> str | None:
    try:
        action(*args, **options)
    except AlarmError as error:
        return error.alarm.number
    return None


@pytest.fixture
def fresh() -> References:
    return References.at_power_on(4, PAIR)


@pytest.fixture
def established(fresh: References) -> References:
    fresh.establish((Y,))
    fresh.establish((X,))
    return fresh


def test_power_on(fresh: References) -> None:
    """Section 0: on an inclined pair not established at program start, all other axes have absolute
    encoders; so it is after changed parameters, which are read at power-on (注意 1)."""
    assert [state.name for state in fresh.states] == ["MISSING", "ESTABLISHED", "MISSING", "ESTABLISHED"]
    assert set(References.at_power_on(4, None).states) == {Reference.ESTABLISHED}
    assert found(fresh.require, X, "X", None) == found(fresh.require, Y, "Y", None) == "PS0224"
    assert found(fresh.require, Z, "Z", None) is None


def test_order_at_first(fresh: References) -> None:
    """The inclined axis before the orthogonal one; the other order, or both at once, is DS0020."""
    assert found(fresh.check_order, (X,), None) == "DS0020"
    assert found(fresh.check_order, (X, Y), None) == "DS0020"
    assert found(fresh.check_order, (Y,), None) is None
    fresh.establish((Y,))
    assert found(fresh.check_order, (X, Y), None) == "DS0020"
    assert found(fresh.check_order, (X,), None) is None


def test_any_order_once_established(established: References) -> None:
    for axes in ((X,), (Y,), (X, Y), (X, Y, Z)):
        assert found(established.check_order, axes, None) is None


def test_order_again_after_the_loss(established: References) -> None:
    """After the inclined axis has moved with NOZAGC = 1 both references are lost: the order rule applies
    again, the axes may move (absolute and machine stay offset)."""
    assert established.lose()
    assert not established.lose()
    assert found(established.check_order, (X,), None) == "DS0020"
    assert found(established.check_order, (X, Y), None) == "DS0020"
    assert found(established.require, X, "X", None) is None
    established.establish((Y,))
    assert found(established.check_order, (X,), None) is None
    established.establish((X,))
    assert established.lose()


def test_loss_does_not_make_a_missing_reference_good(fresh: References) -> None:
    assert not fresh.lose()
    fresh.establish((Y,))
    assert fresh.lose()
    assert found(fresh.require, X, "X", None) == "PS0224"


@pytest.mark.parametrize(("home", "number"), [(True, None), (False, "DS0020")])
def test_orthogonal_axis_needs_the_inclined_one_at_home(established, home: bool, number: str | None) -> None:
    """Manual return or G27 of the orthogonal axis with the inclined axis not on its reference: DS0020 at any
    time (注意 2, 7)."""
    assert found(established.check_orthogonal, (X,), None, inclined_home=home) == number
    assert found(established.check_orthogonal, (Y, Z), None, inclined_home=home) is None


def test_standing_there_is_not_enough_without_the_reference(fresh: References) -> None:
    assert found(fresh.check_orthogonal, (X,), None, inclined_home=True) == "DS0020"


def test_further_points_need_the_first(fresh: References) -> None:
    """Fanuc G30: only after the first reference return."""
    assert found(fresh.check_order, (Y,), None, point=2) == "PS0224"
    assert found(fresh.check_order, (Z,), None, point=4) is None
    fresh.establish((Y,))
    assert found(fresh.check_order, (Y,), None, point=2) is None
    fresh.establish((Y,), point=3)
    assert fresh.reached == {Y: 3}


def test_zp_goes_with_the_axis_own_motion_alone(established: References) -> None:
    """ZPx, ZP2x to ZP4x are Cartesian: motion that the inclined axis induces leaves them alone."""
    assert established.reached == {X: 1, Y: 1}
    established.leave((Y,))
    assert established.reached == {X: 1}


def test_return_of_the_orthogonal_axis_is_due_after_azr_0(established: References) -> None:
    """注意 3: its own return must follow at once, else a warning."""
    established.returned_by_hand(Y, moved_both=True)
    assert established.overdue(None, returning=(X,)) is None
    assert established.overdue(None) is None
    established.returned_by_hand(Y, moved_both=True)
    assert established.overdue(None).number == "HT9120"
    assert established.overdue(None) is None
    established.returned_by_hand(Y, moved_both=False)
    assert established.overdue(None) is None


def test_a_detached_axis_is_as_if_it_were_not_there(established: References) -> None:
    established.detach(Z)
    assert found(established.require, Z, "Z", None) == "PS0009"
    established.attach(Z)
    assert found(established.require, Z, "Z", None) == "PS0224"
    established.attach(X)
    assert found(established.require, X, "X", None) is None


@given(st.floats(-84, 84), st.floats(-500, 500), st.booleans())
def test_manual_return_goes_along_the_programmed_axis_or_the_slide(angle, way, azr) -> None:
    """AZR = 0: the orthogonal slide goes along, so that the tool moves along Y alone; 1: the slide alone."""
    pair = InclinedPair(inclined=Y, orthogonal=X, angle=angle)
    slides = manual_return(pair, Y, way, azr=azr)
    assert slides[Y] == pytest.approx(way, abs=1e-9)
    x, y = slides.get(X, 0.0), slides[Y]
    theta = math.radians(angle)
    cartesian_x = x + y * math.sin(theta)
    assert cartesian_x == pytest.approx(way * math.sin(theta) if azr else 0.0, abs=1e-9)
    assert manual_return(pair, X, way, azr=azr) == {X: way}
    assert manual_return(None, Y, way, azr=azr) == {Y: way}


def test_manual_return_by_hand() -> None:
    """θ = −30°, from the slide position Y115.470, X57.735 (worked case Y100.): both slides go home."""
    ways = manual_return(PAIR, Y, -115.470, azr=False)
    assert ways == {X: pytest.approx(-57.735, abs=1e-3), Y: pytest.approx(-115.470)}
