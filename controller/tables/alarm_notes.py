"""What the alarms mean in plain words, where that is laid down, and which codes raise them: for the manual.

Beside the alarm table, which every program needs, this one is read only by whoever explains.
"""

from dataclasses import dataclass

from controller.tables.alarms import AlarmEntry


@dataclass(frozen=True, slots=True, kw_only=True)
class AlarmNote:
    """What the manual adds to a row of the alarm table."""

    meaning: str
    """one sentence; empty = the text of the alarm says it"""
    clause: str
    codes: tuple[str, ...]
    """G and M codes that raise it; empty = any block"""


# number | clause, § = section of the rulings | codes | meaning
_ROWS = """
PS0003 | §1, Numbers | | a number has more than eight digits
PS0004 | §1, Addresses | | a number or sign stands where an address letter is due
PS0005 | §1, Numbers | | an address letter without a number behind it, as the originals print X F
PS0006 | §1, 2 | | a minus sign where the address takes none, such as S out of sync
PS0007 | §1, Numbers | | two decimal points, or one where an integer is due
PS0009 | §1 | | a word that means nothing in its block: nothing is ever ignored
PS0010 | §1, G codes | | a G code that this controller does not have
PS0011 | §1, Addresses | G01 G02 G03 | a cutting move without a feed
PS0015 | §1 | G00 G01 G02 G03 G28 G30 G53 | more axes than the control moves together (parameter 9004)
PS0020 | §1 | G02 G03 | the end point is not on the circle (parameter 3410)
PS0021 | §1 | G02 G03 G17 G19 | the plane holds a rotary axis, or one that this machine does not have
PS0022 | §1 | G02 G03 | an arc with neither R nor I, J, K
PS0030 | §1, T | G10 | an offset number that does not exist
PS0046 | §1 | G30 | P of G30 is none of 2, 3, 4
PS0060 | §1, Subprograms | M99 | the N number that is called does not exist
PS0061 | §1, G70-G76 | G70 G71 G72 G73 | P or Q of the profile is missing
PS0062 | §1, G70-G76 | G71 G72 G73 G74 G75 G76 | a depth of cut or an allowance makes no sense
PS0063 | §1, G70-G76 | G70 G71 G72 G73 | the N number of P or Q does not exist
PS0064 | §1, G70-G76 | G71 G72 | the profile turns back in X or in Z
PS0065 | §1, G70-G76 | G71 G72 | the profile does not begin with a move of the one axis that feeds in
PS0066 | §1, G70-G76 | G70 G71 G72 G73 | the profile holds a block that is no part of a shape
PS0067 | §1, G70-G76 | G70 G71 G72 G73 | the cycle has no program to read its profile from
PS0076 | §1, Subprograms | M98 G65 G66 | the O program that is called does not exist
PS0077 | §1, Subprograms | M98 | subprograms call each other too deeply
PS0092 | §1 | G27 | the axis does not stand on its reference point
PS0111 | §1, Macro B | | a value beyond the range of numbers
PS0112 | §1, Macro B | | a division by zero
PS0114 | §1, Macro B | | a macro statement or expression that cannot be read
PS0115 | §1, Macro B | | a variable that does not exist
PS0116 | §1, Macro B | | a variable that can only be read
PS0118 | §1, Macro B | | brackets nested too deeply
PS0119 | §1, Macro B | | a function has no value there, such as SQRT of a negative number
PS0122 | §1, Macro B | G65 G66 | macros call each other too deeply
PS0123 | §1, Macro B | | GOTO, WHILE or DO where there is no program to go to
PS0124 | §1, Macro B | | DO and END do not belong together
PS0126 | §1, Macro B | | DO with another number than 1, 2, 3
PS0127 | §1, Macro B | | a macro statement and NC words in one block
PS0128 | §1, Macro B | | GOTO to a number that cannot be a sequence number
PS0129 | §1, Macro B | G65 G66 | an address that cannot pass an argument
PS0197 | §1, C axis | G01 G28 G81 G51.2 | the axis has turned as a spindle and does not know its angle
PS0217 | §3 | G51.2 | G51.2 in polygon turning, parameter 201#4 = 0
PS0218 | polygon, 代码说明 | G51.2 | P or Q missing, or P, Q, R, A out of range
PS0219 | polygon, 注 2 | G51.2 G50.2 | G51.2 or G50.2 shares its block with something else
PS0220 | §3 | G51.2 | what polygon turning forbids: its axes, units, tools, G28 of its axes, M30
PS0224 | §0, References | | an axis without reference point is to move
PS1541 | §1, 2 | M03 M04 G96 G50 | the spindle is to start without a speed
PS1544 | §2 | G97 G81 G51.2 | S above the highest speed of the spindle
PS1593 | §2 | G81 G51.2 | the axes of parameters 197, 198, 199 cannot be geared together
PS1594 | §2 | G81 G80 | T missing, a word out of range, only one of Q and P, axis words, or G80 not alone
PS1595 | §2 | G81 | what hobbing forbids: its master, units, tools, M03, G28 of its axes, M30
PS1596 | §2 | G81 | the work axis would have to turn faster than it can
PS5007 | §1 | | a move longer than any axis
PS5010 | §1, Subprograms | M98 | the text ends inside a subprogram
PS5016 | §1 | | two M codes in one block
PS5018 | §3 | G51.2 | the tool axis would have to turn faster than it can
PS5074 | §1 | | the same address, or two G codes of one group, in one block
OT0500 | §4, stroke limits | | the path leaves stored stroke limit 1 on the plus side
OT0501 | §4, stroke limits | | the path leaves stored stroke limit 1 on the minus side
OT0502 | §4, stroke limits | G22 | the path enters or leaves stored stroke limit 2 on the plus side
OT0503 | §4, stroke limits | G22 | the path enters or leaves stored stroke limit 2 on the minus side
OT0504 | §4, stroke limits | | the path enters the forbidden area of stored stroke limit 3, plus side
OT0505 | §4, stroke limits | | the path enters the forbidden area of stored stroke limit 3, minus side
OT0506 | §4, signals | | the slide stands on its plus limit switch
OT0507 | §4, signals | | the slide stands on its minus limit switch
OT0510 | §4, stroke limits | | the end point lies beyond a stroke limit, found before the motion begins
OT0511 | §4, stroke limits | | the end point lies beyond a stroke limit, found before the motion begins
DS0020 | inclined axis, 参考点返回 | G28 G30 G27 | the orthogonal axis returns before the inclined one has
MC3000 | §1, System variables | | the program itself raises it: #3000 = n, with its message
SV0407 | hobbing, 解除同步 | G81 G51.2 | the slave of the gear box has left its window, parameter 9006
SV0410 | Fanuc alarms | | a standing axis is pushed off its position
SV0411 | Fanuc alarms | | a moving axis lags too far behind
HT9000 | §1 | | the file is no text in UTF-8 or GBK
HT9001 | §1 | | the file holds no block
HT9003 | §1, G codes | | a real code of the control that the twin never runs, rather than wrongly
HT9004 | §1 | | a comment that is not closed in its line
HT9005 | §0, 4 | | parameters that cannot hold together
HT9006 | §1 | | a loop that never moves
HT9007 | §2, G99 | G99 | a feed per revolution while the work stands still
HT9008 | §2 | G81 G51.2 | an axis of the gear box still turns when it is to be engaged
HT9009 | §1, M codes | | an M code that the machine does not have
HT9010 | §1, T | | T in another form than tool and offset
HT9011 | §1, Subprograms | M99 | the main program would begin anew without end
HT9012 | §1 | | a value outside the range of its address
HT9013 | design, The clock | | the machine itself raises an alarm that the table does not name
HT9014 | §3, 4 | G51.2 | a function that excludes the inclined axis
HT9015 | §1, Subprograms | M98 G65 | a call or a loop repeats without end
HT9016 | §1, G70-G76 | G71 G72 G73 G74 G75 G76 G92 | a depth of cut so small that the cycle would never end
HT9020 | §1 | G32 G92 G76 | lead times speed is more than the axes can do
HT9030 | design, The clock | | two bodies of the machine touch that are not cutter and work
HT9031 | patent, touch measurement | | the stylus is pushed beyond its overtravel, or meets what is no band
HT9040 | design, Contract | | motion and cutting forces do not settle: what gives way comes back as more force
HT9041 | design, Contract | | the cut asks for more torque than the tool's drive and its momentum have
HT9100 | hobbing, 注意事项 | G81 G51.2 | the gear box is engaged anew with another ratio while it turns
HT9101 | §5 | G81 | S is negative while hobbing
HT9102 | §2 | G81 | P beyond 85 degrees
HT9103 | §3 | G51.2 | Q is negative: tool and work turn against each other
HT9104 | §1, Numbers | | with parameter 3401#0 = 0 a number without point counts increments
HT9105 | §1 | M30 | the text ends without M30
HT9106 | hobbing, 注 4 | G81 G51.2 | a negative S in follow type, where the machine decides the direction
HT9107 | §4, speeds | | an axis would exceed its own limit: the path is kept, the feed is not
HT9108 | §4, NOZAGC | | the inclined axis has moved without its compensation
HT9109 | §5 | M00 M01 | a stop that nobody ends is passed
HT9110 | §1 | | text behind the closing %, which no controller reads
HT9111 | §4, 8210 | | an inclination for which the function is undefined
HT9112 | §3 | G81 | hobbing with the inclined axis active
HT9113 | §2 | G81 G51.2 | the text ends while the gear box is on
HT9114 | §1, System variables | | #3006 stops with a message, and nobody presses cycle start
HT9120 | §4, AZR | | the inclined axis has returned by hand and the orthogonal one has not followed
HT9121 | §4, signals | | the interlock of the orthogonal axis does not stop what the inclined one induces
HT9123 | §4, signals | | an axis is moved by hand while its mirror image is on
HT9124 | §4, NOZAGC | | a name that the original misprints
HT9130 | §5 | | the program waits, and no later event ends the hold, the stop or the override of 0
HT9131 | §5 | | the operator did what the controller refuses or ignores in that state
HT9132 | §2 | G81 G51.2 | the spindle override changed while the tool was cutting in sync
HT9133 | §1 | G31 | without a machine nobody knows where the probe touches
HT9134 | §5 | | RESET ended the program, and nobody started it again
HT9135 | §5 | | the emergency stop ended the program
HT9136 | §4, signals | | a jog of one axis of the inclined pair is Cartesian
HT9137 | §5 | | the program ended before the event was due
"""


def _table(text: str) -> dict[str, AlarmNote]:
    rows = ([cell.strip() for cell in line.split("|")] for line in text.strip().splitlines())
    return {
        number: AlarmNote(
            clause=clause.replace("§", "rulings, section "), codes=tuple(codes.split()), meaning=meaning
        )
        for number, clause, codes, meaning in rows
    }


NOTES: dict[str, AlarmNote] = _table(_ROWS)
"""Notes by alarm number."""

_CLAUSE_OF = {
    "PS": "Fanuc alarms, program",
    "OT": "Fanuc alarms, overtravel",
    "SV": "Fanuc alarms, servo",
    "DS": "Fanuc alarms, system",
    "MC": "Fanuc alarms, macro",
    "HT": "hobtwin's own",
}


def note_of(entry: AlarmEntry) -> AlarmNote:
    """The note of an alarm; of one without its own, the list that its number comes from."""
    found = NOTES.get(entry.number)
    return found or AlarmNote(meaning="", clause=_CLAUSE_OF.get(entry.number[:2], ""), codes=())
