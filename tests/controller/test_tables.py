"""The tables: nothing raised that is not in them, nothing of our own in them that is never raised."""

import re
from pathlib import Path

import pytest

import controller
from controller.span import Span
from controller.tables.alarms import ALARMS, Alarm, AlarmClass, Severity
from controller.tables.codes import G_CODES, POWER_ON, Group, g_name

FILES = Path(controller.__path__[0]).rglob("*.py")
SOURCES = [path.read_text() for path in FILES if path.name != "alarms.py"]
MUST_EXIST = """
G00 G01 G02 G03 G04 G10 G17 G18 G20 G21 G22 G23 G27 G28 G30 G31 G32 G40 G41 G42 G50 G52 G53 G54 G55 G56 G57
G58 G59 G65 G66 G67 G70 G71 G72 G73 G74 G75 G76 G80 G81 G90 G92 G94 G96 G97 G98 G99 G50.2 G51.2 G61 G64
"""


def test_every_alarm_raised_is_in_the_table() -> None:
    raised = {number for text in SOURCES for number in re.findall(r'"((?:PS|HT|OT|DS|SV)\d{4})"', text)}
    assert raised - set(ALARMS) == set()
    from_the_machine = {"SV0407", "SV0410", "SV0411", "SV0436", "HT9030", "HT9031", "HT9040", "HT9041"}
    from_the_machine |= {"HT9032", "HT9033", "HT9034"}
    families = {"MC3000"}
    assert set(ALARMS) - raised <= from_the_machine | families


def test_every_code_of_the_rulings_has_a_row() -> None:
    """Rulings, section 1, "G codes that must work"."""
    assert set(MUST_EXIST.split()) <= {g_name(code) for code in G_CODES}


def test_power_on_state_has_one_code_of_every_modal_group() -> None:
    """Rulings, section 0: G00 G97 G98 G18 G21 G23 G40 G54 G64 G67 G80 G50.2."""
    assert set(POWER_ON) == set(Group) - {Group.ONE_SHOT}
    stated = ("G00", "G97", "G98", "G18", "G21", "G23", "G40", "G54", "G64", "G67", "G80", "G50.2")
    assert set(stated) <= {g_name(code) for code in POWER_ON.values()}


@pytest.mark.parametrize(
    ("number", "kind"),
    [
        ("PS0005", AlarmClass.PROGRAM),
        ("OT0500", AlarmClass.OVERTRAVEL),
        ("SV0411", AlarmClass.SERVO),
        ("HT9013", AlarmClass.SERVO),
        ("DS0020", AlarmClass.SYSTEM),
    ],
)
def test_classes(number: str, kind: AlarmClass) -> None:
    assert Alarm(number=number, found="").kind is kind


def test_the_line_that_is_printed() -> None:
    alarm = Alarm(number="PS0005", found="X", span=Span(file="a.nc", line=2, column=5))
    assert str(alarm) == (
        "a.nc:2:5: error[PS0005]: NO DATA AFTER ADDRESS: found X; valid: a number after the address"
    )
    assert Alarm(number="HT9101", found="").severity is Severity.WARNING
