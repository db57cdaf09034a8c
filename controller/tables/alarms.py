"""The alarm table and the alarm itself. Known numbers are Fanuc's, because users know them; ours: HT9000 ff.

Source: rulings, section 1, "Alarm texts". A row says what an alarm means and what mends it in general; the
alarm raised at a place says what was found there and what would have been valid.
"""

from dataclasses import dataclass, replace
from enum import Enum

from controller.span import Span


class AlarmClass(Enum):
    """Program and user alarms leave the electronic gear box on, all others cancel it (hobbing, 注意事项)."""

    PROGRAM = "program"
    USER = "user"
    OVERTRAVEL = "overtravel"
    SERVO = "servo"
    SYSTEM = "system"


class Severity(Enum):
    """An error stops the program, a warning does not."""

    ERROR = "error"
    WARNING = "warning"


@dataclass(frozen=True, slots=True, kw_only=True)
class AlarmEntry:
    """One row of the alarm table."""

    number: str
    text: str
    remedy: str
    """what mends it in general"""
    severity: Severity = Severity.ERROR

    @property
    def kind(self) -> AlarmClass:
        """The class that the number or its prefix stands for."""
        return _CLASS_OF.get(self.number) or _CLASS_OF[self.number[:2]]


_CLASS_OF = {
    "HT9013": AlarmClass.SERVO,
    "HT9030": AlarmClass.SERVO,
    "HT9031": AlarmClass.SERVO,
    "HT9032": AlarmClass.SERVO,
    "HT9033": AlarmClass.SERVO,
    "HT9034": AlarmClass.SERVO,
    "HT9040": AlarmClass.SERVO,
    "HT9041": AlarmClass.SERVO,
    "PS": AlarmClass.PROGRAM,
    "HT": AlarmClass.PROGRAM,
    "OT": AlarmClass.OVERTRAVEL,
    "SV": AlarmClass.SERVO,
    "DS": AlarmClass.SYSTEM,
    "MC": AlarmClass.USER,
}

_ERRORS = """
PS0003 | TOO MANY DIGIT | at most 8 digits after an address
PS0004 | INVALID BREAK POINT OF WORDS | an address letter before every number
PS0005 | NO DATA AFTER ADDRESS | a number after the address
PS0006 | ILLEGAL USE OF MINUS SIGN | a number without minus sign, or one sign before the digits
PS0007 | ILLEGAL USE OF DECIMAL POINT | one point, and only where the address takes one
PS0009 | IMPROPER NC-ADDRESS | an address of this machine
PS0010 | IMPROPER G-CODE | a G code of this controller
PS0011 | FEED ZERO (COMMAND) | F greater than 0 before or in the block
PS0015 | TOO MANY SIMULTANEOUS AXES | fewer axes in the block, or a greater parameter 9004
PS0020 | OVER TOLERANCE OF RADIUS | an end on the circle, or a greater parameter 3410
PS0021 | ILLEGAL PLANE SELECT | a plane of two linear axes: G18 on this lathe
PS0022 | R OR I,J,K COMMAND NOT FOUND | R, or the centre by the I J K of the plane
PS0030 | ILLEGAL OFFSET NUMBER | offset numbers 00 to 99
PS0046 | ILLEGAL REFERENCE RETURN COMMAND | P2, P3 or P4 with G30
PS0060 | SEQUENCE NUMBER NOT FOUND | an N number of the program
PS0061 | P OR Q COMMAND IS NOT IN THE MULTIPLE REPETIVE CYCLES BLOCK | P and Q, the N of the profile
PS0062 | THE CUTTING AMOUNT IS ILLEGAL IN THE ROUGH CUTTING CYCLE | amounts of cut above zero
PS0063 | THE BLOCK OF A SPECIFIED SEQUENCE NUMBER IS NOT FOUND | N numbers of this program, P before Q
PS0064 | THE FINISHING SHAPE IS NOT A MONOTONOUS CHANGE | a profile that goes one way in X and in Z
PS0065 | G00/G01 IS NOT IN THE FIRST BLOCK OF THE SHAPE PROGRAM | G00 or G01 with X for G71, with Z for G72
PS0066 | UNAVAILABLE COMMAND IS IN THE SHAPE PROGRAM | G00 to G03 with X and Z, F and S in the profile
PS0067 | THE MULTIPLE REPETIVE CYCLES IS NOT IN THE PART PROGRAM STORAGE | G70 to G73 in a program
PS0076 | PROGRAM NOT FOUND | an O number of the file
PS0077 | TOO MANY SUB,MACRO NESTING | at most 10 levels of M98
PS0111 | OVERFLOW :FLOATING | a result within the range of numbers
PS0112 | ZERO DIVIDE | a divisor other than zero
PS0114 | ILLEGAL EXPRESSION FORMAT | an expression of custom macro B
PS0115 | VARIABLE NO. OUT OF RANGE | #1 to #33, #100 to #199, #500 to #999, or a system variable
PS0116 | WRITE PROTECTED VARIABLE | a variable that can be written
PS0118 | TOO MANY BRACKET NESTING | at most 5 brackets within each other
PS0119 | ARGUMENT VALUE OUT OF RANGE | an argument for which the function has a value
PS0122 | TOO MANY MACRO NESTING | at most 5 levels of G65 and G66
PS0123 | ILLEGAL MODE FOR GOTO/WHILE/DO | macro statements in a program
PS0124 | MISSING END STATEMENT | DO m and END m in pairs, loops wholly inside each other
PS0126 | ILLEGAL LOOP NUMBER | DO and END with 1, 2 or 3
PS0127 | DUPLICATE NC,MACRO STATEMENT | a block of its own for a macro statement
PS0128 | ILLEGAL MACRO SEQUENCE NUMBER | a whole sequence number from 1 to 99999999
PS0129 | USE 'G' AS ARGUMENT | G65 or G66 with P, L and arguments A to Z but G, L, N, O, P
PS0092 | AXES NOT ON THE REFERENCE POINT | a position from which the axis goes to its reference point
PS0197 | C-AXIS COMMANDED IN SPINDLE MODE | M19 or G28 H0 before the block
PS0217 | DUPLICATE G51.2 (COMMANDS) | G50.2 first, or parameter 201#4 = 1
PS0218 | NOT FOUND P/Q COMMAND | P 1 to 999, Q -999 to 999 but 0, R 0 to 9999.999, A any lead
PS0219 | COMMAND G51.2/G50.2 INDEPENDENTLY | G51.2 and G50.2 alone in their block
PS0220 | ILLEGAL COMMAND IN SYNCHR-MODE | G50.2 before the block
PS0224 | ZERO RETURN NOT FINISHED | G28 of the axis before the block
PS1541 | S-CODE ZERO | S greater than 0 before the spindle starts
PS1544 | S-CODE OVER MAX | S within the spindle's highest speed (parameter 3772)
PS1593 | EGB PARAMETER SETTING ERROR | parameters 197, 198: two rotary axes of type A; 199: a linear axis
PS1594 | EGB FORMAT ERROR | G81 T__ L__ (Q__ P__); G80 alone in its block
PS1595 | ILL-COMMAND IN EGB MODE | G80 before the block
PS1596 | EGB OVERFLOW | a speed of the hob that the work axis can follow (parameter 3772)
PS5007 | TOO LARGE DISTANCE | a shorter distance
PS5010 | END OF RECORD | M99 at the end of a subprogram
PS5016 | ILLEGAL COMBINATION OF M CODES | one M code in a block
PS5018 | POLYGON SPINDLE SPEED ERROR | a work speed that the tool axis can follow (parameter 3772)
PS5074 | ADDRESS DUPLICATION ERROR | each address, and each group of G codes, once in a block
OT0500 | + OVERTRAVEL (SOFT 1) | a path inside the stored stroke limit 1 (parameter 1320)
OT0501 | - OVERTRAVEL (SOFT 1) | a path inside the stored stroke limit 1 (parameter 1321)
OT0502 | + OVERTRAVEL (SOFT 2) | a path that keeps to stored stroke limit 2 (parameters 1322, 1323), or G23
OT0503 | - OVERTRAVEL (SOFT 2) | a path that keeps to stored stroke limit 2 (parameters 1322, 1323), or G23
OT0504 | + OVERTRAVEL (SOFT 3) | a path outside the stored stroke limit 3 (parameters 1324, 1325)
OT0505 | - OVERTRAVEL (SOFT 3) | a path outside the stored stroke limit 3 (parameters 1324, 1325)
OT0506 | + OVERTRAVEL (HARD) | a way back in the minus direction, or signal *+L of the axis = 1
OT0507 | - OVERTRAVEL (HARD) | a way back in the plus direction, or signal *-L of the axis = 1
OT0510 | + OVERTRAVEL (PRE-CHECK) | an end point that keeps to the stored stroke limits (parameter 1301#7)
OT0511 | - OVERTRAVEL (PRE-CHECK) | an end point that keeps to the stored stroke limits (parameter 1301#7)
DS0020 | REFERENCE RETURN INCOMPLETE | G28 of the inclined axis, then in its own block of the orthogonal one
MC3000 | USER ALARM | what the message of the macro asks for; MC3000 + n for #3000 = n
SV0407 | EXCESS ERROR | a motion that the drives can follow
SV0410 | EXCESS ERROR (STOP) | a load that the drives can hold
SV0411 | EXCESS ERROR (MOVING) | a motion and a load that the drives can follow
SV0436 | SOFT THERMAL (OVC) | a load and an acceleration within the motor's torque
HT9000 | PROGRAM CANNOT BE READ | a text file in UTF-8 or GBK
HT9001 | EMPTY PROGRAM | at least one block
HT9003 | NOT SUPPORTED BY THE TWIN | another way to say it
HT9004 | COMMENT NOT CLOSED | ( and ) in the same line
HT9005 | PARAMETERS CONTRADICT EACH OTHER | parameters that agree
HT9006 | TOO MANY STEPS WITHOUT MOTION | a loop that moves or ends
HT9007 | FEED PER REVOLUTION WITH THE SPINDLE AT STANDSTILL | S before the block, or G98
HT9008 | AXIS OF THE GEAR BOX STILL TURNS | the axis at standstill: S0 in sync, else M05 or G28 H0 V0
HT9009 | UNKNOWN M CODE | M00 to M05, M08, M09, M19, M30, M98, M99
HT9010 | IMPROPER T CODE | T with tool and offset, as in T0101
HT9011 | MAIN PROGRAM WITHOUT END | M30 at the end of the main program
HT9012 | IMPROPER VALUE | a value in the range of the address
HT9013 | MACHINE ALARM | see the message of the machine
HT9014 | FORBIDDEN WITH THE INCLINED AXIS | parameter 8200#0 = 0
HT9015 | TOO MANY REPETITIONS | a program whose loops and calls repeat less
HT9016 | TOO MANY PASSES IN A CYCLE | a larger depth of cut
HT9020 | THREAD TOO FAST FOR THE AXES | a lower spindle speed, or a smaller lead
HT9030 | COLLISION | a path on which nothing but the cutter touches the work
HT9031 | TOUCH PROBE CRASH | a path on which the stylus meets a reference band alone, and stops in time
HT9032 | RAPID INTO THE STOCK | G00 to clear of the metal that stands, then a feed
HT9033 | CUTTING WITH THE TOOL AT REST | S before the block
HT9034 | HOBBING WITH THE WORK AT REST | T, L, P and Q with which the work turns
HT9040 | UNSTABLE CUT | less feed or depth, another speed, stiffer mounts or a stronger tool drive
HT9041 | TOOL STALLS IN THE CUT | less feed or depth, more passes, or a stronger tool drive
"""

_WARNINGS = """
HT9100 | SPEED JUMP ON THE SLAVE AXIS | S0 before T, L, P or Q change
HT9101 | THE HOB RUNS BACKWARDS | S greater than 0 while hobbing
HT9102 | HELIX ANGLE NEAR 90 DEGREES | P within 85 degrees
HT9103 | OPPOSITE SENSES CUT SCALLOPS, NOT FLATS | Q greater than 0
HT9104 | NUMBER WITHOUT DECIMAL POINT COUNTED IN LEAST INCREMENTS | a decimal point, or parameter 3401#0 = 1
HT9105 | PROGRAM ENDS WITHOUT M30 | M30 at the end
HT9106 | SIGN OF S IGNORED | S greater than 0; the machine decides the direction (follow type, 201#7 = 1)
HT9107 | FEED SLOWED BY AN AXIS LIMIT | a feed within the limit
HT9108 | REFERENCES OF THE INCLINED PAIR LOST | reference return of the inclined, then of the orthogonal axis
HT9109 | STOP CODE PASSED WITHOUT OPERATOR | nothing; the program goes on as if cycle start were pressed
HT9110 | TEXT AFTER THE END OF TAPE | the second % at the very end
HT9111 | INCLINED AXIS FUNCTION OFF BY ITS ANGLE | 8210 away from 85 to 95 degrees
HT9112 | HOBBING WITH AN INCLINED AXIS | nothing; the originals are silent about this pair
HT9113 | PROGRAM ENDS WITH THE GEAR BOX ON | G80 or G50.2 before the end
HT9114 | STOP WITH MESSAGE PASSED WITHOUT OPERATOR | nothing; it goes on as if cycle start were pressed
HT9120 | RETURN OF THE ORTHOGONAL AXIS DID NOT FOLLOW AT ONCE | its return right after the inclined axis
HT9121 | INTERLOCK DOES NOT STOP INDUCED MOTION | *IT = 0 of the inclined axis, too
HT9123 | MIRROR IMAGE ON IN MANUAL OPERATION | signal MI of the axis = 0 before any motion by hand
HT9124 | MISPRINTED SIGNAL NAME | NOZAGC
HT9130 | PROGRAM LEFT STANDING | an event that lets it go on, such as cycle start
HT9131 | OPERATOR ACTION WITHOUT EFFECT | an action that is possible then
HT9132 | SPINDLE OVERRIDE CHANGED WHILE CUTTING IN SYNC | a change of speed while the axes stand
HT9133 | SKIP SIGNAL CANNOT BE FORESEEN | nothing; without a machine the move goes to its end
HT9134 | PROGRAM ENDED BY RESET | cycle start to begin it anew
HT9135 | EMERGENCY STOP | RESET, then cycle start to begin the program anew
HT9136 | JOG OF AN INCLINED PAIR MOVES BOTH SLIDES | signal NOZAGC = 1 to move them independently
HT9137 | OPERATOR EVENT NEVER CAME | a time or a line that the program reaches
"""


def _table(text: str, severity: Severity) -> dict[str, AlarmEntry]:
    rows = (line.split(" | ") for line in text.strip().splitlines())
    return {
        number: AlarmEntry(number=number, text=words, remedy=remedy, severity=severity)
        for number, words, remedy in rows
    }


ALARMS: dict[str, AlarmEntry] = _table(_ERRORS, Severity.ERROR) | _table(_WARNINGS, Severity.WARNING)
"""Every alarm and warning the controller can raise, by number."""

_FAMILY = {"MC": "MC3000"}
"""prefix -> the row that stands for all numbers of a family: MC3001 is alarm 1 of a macro"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Alarm:
    """An alarm or warning raised at a place."""

    number: str
    """a key of `ALARMS`"""
    found: str
    """what was found"""
    span: Span | None = None
    valid: str = ""
    """what would have been valid here; empty = the remedy of the table"""

    @property
    def entry(self) -> AlarmEntry:
        """The row of the table."""
        row = ALARMS.get(self.number)
        return row or replace(ALARMS[_FAMILY[self.number[:2]]], number=self.number)

    @property
    def text(self) -> str:
        """The controller's own words."""
        return self.entry.text

    @property
    def kind(self) -> AlarmClass:
        """The class, which decides what becomes of the gear box."""
        return self.entry.kind

    @property
    def severity(self) -> Severity:
        """Error or warning."""
        return self.entry.severity

    @property
    def remedy(self) -> str:
        """What would have been valid."""
        return self.valid or self.entry.remedy

    def __str__(self) -> str:
        place = f"{self.span}: " if self.span else ""
        head = f"{place}{self.severity.value}[{self.number}]: {self.text}"
        return f"{head}: found {self.found}; valid: {self.remedy}"


def as_json(alarm: Alarm) -> dict[str, str | int | None]:
    """An alarm as plain values, place from 1."""
    span = alarm.span or Span(file="")
    return {
        "number": alarm.number,
        "class": alarm.kind.value,
        "text": alarm.text,
        "file": span.file or None,
        "line": span.line,
        "column": span.column,
        "found": alarm.found,
        "remedy": alarm.remedy,
    }


class ControllerError(Exception):
    """Something the user of the controller can mend. `str()` is the one line to print."""

    def __init__(self, text: str, *, remedy: str = "") -> None:
        super().__init__(text)
        self.text = text
        self.remedy = remedy

    def __str__(self) -> str:
        return f"error: {self.text} (valid: {self.remedy})" if self.remedy else f"error: {self.text}"


class AlarmError(ControllerError):
    """An alarm on its way to whoever can place it in time."""

    def __init__(self, alarm: Alarm) -> None:
        super().__init__(str(alarm), remedy=alarm.remedy)
        self.alarm = alarm

    def __str__(self) -> str:
        return self.text


def alarm(number: str, found: str, span: Span | None = None, *, valid: str = "") -> AlarmError:
    """An `AlarmError` ready to raise; `number` is a key of `ALARMS`."""
    return AlarmError(Alarm(number=number, found=found, span=span, valid=valid))
