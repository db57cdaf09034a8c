import pytest

from controller.tables.alarms import AlarmError, ControllerError
from controller.tables.machine_data import machine_data
from controller.tables.parameter_table import PARAMETERS
from controller.tables.parameters import delivered


def test_delivered_setups() -> None:
    """Rulings, section 0: axes and numbers of both set-ups, all bits of 201, 8200, 8201, 8209 zero."""
    expected = {
        "hobbing": ("XZYC", {197: 3, 198: 4, 199: 2}),
        "tilted": ("XZYCB", {197: 5, 198: 4, 199: 2, 8210: -30000, 8211: 3, 8212: 1}),
    }
    for setup, (letters, words) in expected.items():
        parameters = delivered(setup)
        machine = machine_data(parameters)
        assert "".join(machine.letters) == letters
        assert {number: parameters.number(number) for number in words} == words
        assert all(parameters.number(number) == 0 for number in (201, 8200, 8201, 8209))
        assert machine.pair is None
        for axis in machine.axes:
            if axis.rotary:
                assert axis.type_a
                assert axis.spindle_max >= (2000 if axis.letter == "C" else 4000)
            else:
                assert axis.upper >= 300.0
                assert axis.lower <= -300.0
                assert 10_000 <= axis.rapid * 60 <= 20_000


@pytest.mark.parametrize("setup", ["hobbing", "tilted"])
def test_every_parameter_is_delivered_with_a_value(setup: str) -> None:
    assert set(PARAMETERS) == {number for number, _ in delivered(setup).values}


def test_overrides_of_a_bit_an_axis_and_an_axis_bit() -> None:
    parameters = delivered("hobbing", {"201#4": "1", "201#2": 1, "1320.Z": "250.0", "1006#3.X": 0})
    assert parameters.number(201) == 0b00010100
    assert parameters.number(1320, "Z") == 250.0
    assert not parameters.bit(1006, 3, "X")
    assert delivered("hobbing", {"201#4": 1, "201#4 ": 0}).number(201) == 0


@pytest.mark.parametrize(
    ("value", "angle"), [("-30000", -30.0), (-30.0, -30.0), ("-30.", -30.0), ("15500", 15.5)]
)
def test_8210_counts_thousandths_unless_it_has_a_point(value: str | float, angle: float) -> None:
    """Rulings, section 0."""
    pair = machine_data(delivered("tilted", {"8200#0": 1, "8210": value})).pair
    assert pair is not None
    assert pair.angle == angle


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("x", 1, "names no parameter"),
        ("202#1", 1, "unknown parameter 202"),
        ("201", 1, "bit by bit"),
        ("201#0", 1, "201#7, 201#4, 201#3, 201#2"),
        ("201#4", 2, "out of range"),
        ("201#4.X", 1, "belongs to no axis"),
        ("1320", 1, "1320.X, 1320.Z"),
        ("1320.Q", 1, "belongs to an axis"),
        ("1320.Z", "far", "is no number"),
        ("1320.Z", "nan", "out of range"),
        ("1320#1.Z", 1, "has no bits"),
        ("197", 6, "0 to 5"),
        ("197", 2.5, "no integer"),
        ("8210", 181.0, "out of range"),
    ],
)
def test_wrong_overrides_are_refused_by_name(key: str, value: str | float, message: str) -> None:
    with pytest.raises(ControllerError, match="error: ") as caught:
        delivered("hobbing", {key: value})
    assert message in str(caught.value)
    assert key.split("#", maxsplit=1)[0].split(".", maxsplit=1)[0] in str(caught.value)


def test_unknown_setup() -> None:
    with pytest.raises(ControllerError, match="hobbing or tilted"):
        delivered("lathe")


@pytest.mark.parametrize(
    ("overrides", "found"),
    [
        ({"8200#0": 1, "8211": 0}, "8211 = 0, 8212 = 1"),
        ({"8200#0": 1, "8212": 3}, "8211 = 3, 8212 = 3"),
        ({"8200#0": 1, "8212": 9}, "8212 = 9"),
        ({"8200#0": 1, "8211": 4}, "8211 = 4, a rotary axis"),
        ({"1321.Z": 500}, "1320.Z not above 1321.Z"),
        ({"1020.B": "C"}, "1020.B = C"),
        ({"9003": 0}, "9003 = 0"),
    ],
)
def test_contradictions(overrides: dict[str, float], found: str) -> None:
    """Rulings, section 4: 8211 and 8212 are looked at only when 8200#0 = 1."""
    with pytest.raises(AlarmError) as caught:
        machine_data(delivered("tilted", overrides))
    assert caught.value.alarm.number == "HT9005"
    assert found in caught.value.alarm.found


def test_a_pair_that_is_off_is_not_looked_at() -> None:
    assert machine_data(delivered("tilted", {"8211": 0, "8212": 0})).pair is None


def test_every_row_has_its_clause() -> None:
    assert all(entry.clause and entry.meaning for entry in PARAMETERS.values())
