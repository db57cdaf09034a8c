"""Behind the first alarm only what a line says by itself is called wrong."""

import pytest

from controller.language.source import parse_program
from controller.read_on import BY_ITSELF, MOST_ALARMS, alarms_behind
from controller.tables.alarms import ALARMS
from controller.tables.parameters import delivered


def numbers(
    *lines: str, setup: str = "hobbing", parameters: dict[str, str] | None = None
) -> list[tuple[str, int]]:
    program = parse_program("\n".join(["O1", "G01 X1.", *lines]) + "\n")
    found = alarms_behind(program, delivered(setup, parameters), 2)
    return [(one.number, one.span.line if one.span else 0) for one in found]


@pytest.mark.parametrize(
    "line",
    [
        "S-300",  # fine in sync
        "G01 X5.",  # the feed may stand above
        "X5. R-1.",  # a taper of a modal cycle
        "C90.",  # the spindle may be in position control
        "G80",
        "G50.2",
        "M99",
        "M98 P77",
        "T0101",
        "#1=[2",
        "IF[#1 EQ 1] GOTO 7",
        "(a comment)",
        "%",
        "",
    ],
)
def test_what_a_state_could_excuse_is_not_listed(line):
    assert numbers(line) == []


@pytest.mark.parametrize(
    ("line", "number"),
    [
        ("X", "PS0005"),
        ("X1..", "PS0007"),
        ("X--1.", "PS0006"),
        ("X123456789", "PS0003"),
        ("5", "PS0004"),
        ("G999", "PS0010"),
        ("E5", "PS0009"),
        ("M77", "HT9009"),
        ("M03 M04", "PS5016"),
        ("X1. X2.", "PS5074"),
        ("G00 G01 X1.", "PS5074"),
        ("G41 X1.", "HT9003"),
        ("(open", "HT9004"),
        ("T5", "HT9010"),
        ("G81 L1", "PS1594"),
        ("G81 T0", "PS1594"),
        ("G81 T20 L1 Q2.", "PS1594"),
        ("G51.2 P2", "PS0218"),
        ("G51.2 P2 Q4 S300", "PS0219"),
        ("G50.2 X1.", "PS0219"),
        ("G00 X300000.", "PS5007"),
        ("G02 X1. Z1. F100.", "PS0022"),
    ],
)
def test_what_a_line_says_by_itself_is_listed_at_its_line(line, number):
    assert numbers("G00 X1.", line, "G00 X2.") == [(number, 4)]


def test_parameters_count():
    """PS1593 and the inclined axis depend on parameters alone (rulings, sections 2, 3)."""
    assert numbers("G81 T20 L1", parameters={"197": "1"}) == [("PS1593", 3)]
    assert numbers("G51.2 P2 Q4", setup="tilted", parameters={"8200#0": "1"}) == [("HT9014", 3)]


def test_letters_of_the_machine_count():
    """B is an axis of the tilted set-up, of the other none."""
    assert numbers("G00 B5.") == [("PS0009", 3)]
    assert numbers("G00 B5.", setup="tilted") == []


def test_the_list_ends():
    assert len(numbers(*["G999"] * (MOST_ALARMS + 50))) == MOST_ALARMS


def test_what_is_known_by_itself_is_in_the_table():
    assert set(ALARMS) >= BY_ITSELF
