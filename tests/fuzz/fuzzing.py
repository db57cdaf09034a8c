"""Random programs: composed of what a program is made of, and real ones mutated. Fixed seeds, so a finding
comes back: `python tests/fuzz/fuzzing.py COUNT [FIRST_SEED]` runs as many as wanted."""

import random
import sys
import time
import traceback
from pathlib import Path

from controller.dry_run import dry_run
from controller.language import flow, interpreter
from controller.language.cycles import threads, words
from controller.language.source import parse_program
from controller.tables.alarms import ControllerError
from controller.tables.parameters import delivered

ROOT = Path(__file__).parents[2]
SOURCES = sorted([*ROOT.glob("tests/programs/*/*.nc"), *ROOT.glob("scenes/*/*.nc")])


def _words(text: str) -> list[str]:
    return text.split()


CODES = _words("""
G00 G01 G02 G03 G04 G10 G11 G17 G18 G19 G20 G21 G22 G23 G27 G28 G30 G31 G32 G40 G41 G50 G52 G53 G54 G55 G59
G61 G64 G65 G66 G67 G70 G71 G72 G73 G74 G75 G76 G80 G81 G90 G92 G94 G96 G97 G98 G99 G50.2 G51.2 G12.1 G07.1
G84 G123
""")
ADDRESSES = "XZYCUWVHABFSTPQRIJKLDEMN"
NUMBERS = _words("""
0 1 2 3 5 10 20 100 200 500 1000 5000 99999 12345678 123456789 -1 -2.5 -10. 0.001 .5 1.5 2. 10. 45. 90. -30.
360. 0.1 +3. 1.2.3 -- . 99999.999 -99999.999
""")
VARIABLES = _words("""
#0 #1 #2 #3 #24 #26 #33 #34 #100 #101 #199 #500 #999 #1000 #2001 #2101 #3001 #4001 #4109 #5001 #5021 #5041
#5061 #5081 #5221 #[#1] #[#1+1]
""")
FUNCTIONS = _words("SIN COS TAN ASIN ACOS ATAN SQRT ABS ROUND FIX FUP LN EXP BIN BCD FOO")
OPERATORS = _words("+ - * / MOD AND OR XOR")
COMPARISONS = _words("EQ NE GT LT GE LE")
LINES = (
    """
M03 S500|M05|M19|M08|S300|S-200|S0|G81 T20 L1|G81 T20 L1 Q2. P20.|G80|G51.2 P3 Q6|G51.2 P2 Q6 R30. A50.|G50.2
M00|M01|G71 U2. R0.5|G71 P10 Q20 U0.4 W0.1 F200|G72 W1. R0.5|G72 P10 Q20 U0.4 W0.1 F200|G70 P10 Q20
G73 U3. W1. R3|G73 P10 Q20 U0.4 W0.1 F200|N10 G00 X30.|N10 G00 Z-10.|G01 Z-10. F100|X50. Z-20.
G02 X70. Z-30. R10.|N20 G01 X100.|%|G76 P020060 Q50 R0.02|G76 X30. Z-20. P1200 Q500 F1.5|G74 R1.
G74 Z-20. Q5000 F50|G75 R0.5|G75 X40. Z-6. P2000 Q3000 F50|G28 U0 W0|G28 H0 V0|M98 P2|M98 P3 L3|M98 P30002
M99|M99 P10|G65 P2 A1. B2.|G66 P3 X5.|G67|GOTO 10|DO1|END1|DO2|END2|M30|M02|O0002|O0003|G54|G55 G00 X0|T0101
G50 X50. Z2.|G50 S2000|G96 S150|G97 S300|/G00 X1.|/2 M30|(comment)|(open|; note|；注|N10|N20
""".strip()
    .replace("\n", "|")
    .split("|")
)


def compose(rng: random.Random) -> str:
    """A program of statements that could be meant."""
    lines = [_line(rng) for _ in range(rng.randint(1, 14))]
    if rng.random() < 0.3:
        lines += ["O0002", *(_line(rng) for _ in range(rng.randint(0, 4))), "M99"]
    return "\n".join(lines)


def _line(rng: random.Random) -> str:
    kind = rng.random()
    if kind < 0.4:
        return rng.choice(LINES)
    if kind < 0.65:
        words = [rng.choice(CODES) for _ in range(rng.choice([0, 1, 1, 1, 2]))]
        words += [rng.choice(ADDRESSES) + _number(rng) for _ in range(rng.randint(0, 5))]
        return " ".join(words)
    if kind < 0.8:
        return f"{rng.choice(VARIABLES)}={_expression(rng, 3)}"
    if kind < 0.87:
        then = rng.choice(["GOTO 10", "GOTO 20", "THEN #1=1", "THEN #3000=1(X)", "M30"])
        return f"IF[{_comparison(rng)}]{then}"
    if kind < 0.93:
        n = rng.randint(1, 3)
        body = "\n".join(["#1=#1+1", *(_line(rng) for _ in range(rng.randint(0, 2)))])
        return f"#1={rng.randint(0, 5)}\nWHILE[#1 LT {rng.randint(0, 9)}]DO{n}\n{body}\nEND{n}"
    return "".join(rng.choice("GMXZ0123456789.-+#[]=()/;%＃ \t") for _ in range(rng.randint(0, 20)))


def _number(rng: random.Random) -> str:
    return (
        rng.choice(NUMBERS) if rng.random() < 0.85 else rng.choice([*VARIABLES, f"[{_expression(rng, 2)}]"])
    )


def _expression(rng: random.Random, depth: int) -> str:
    kind = rng.random()
    if depth == 0 or kind < 0.3:
        return rng.choice(VARIABLES + NUMBERS[:20])
    if kind < 0.5:
        return f"{rng.choice(FUNCTIONS)}[{_expression(rng, depth - 1)}]"
    inner = f"{_expression(rng, depth - 1)} {rng.choice(OPERATORS)} {_expression(rng, depth - 1)}"
    return f"[{inner}]" if kind < 0.8 else inner


def _comparison(rng: random.Random) -> str:
    return f"{_expression(rng, 2)} {rng.choice(COMPARISONS)} {_expression(rng, 2)}"


def mutate(rng: random.Random, text: str) -> str:
    """A real program with a few pieces changed."""
    for _ in range(rng.randint(1, 6)):
        at = rng.randrange(len(text) + 1)
        to = min(len(text), at + rng.randint(0, 6))
        kind = rng.random()
        if kind < 0.3:
            text = text[:at] + text[to:]
        elif kind < 0.6:
            text = (
                text[:at]
                + rng.choice("GMXZSTFPQRLNO#[]=()/%;.-+0123456789\n\0\x7f\u3000１é\ud800")
                + text[to:]
            )
        elif kind < 0.8:
            text = text[:at] + "\n" + _line(rng) + "\n" + text[at:]
        else:
            lines = text.split("\n")
            lines.insert(rng.randrange(len(lines)), rng.choice(lines))
            text = "\n".join(lines)
    return text


def program_of(seed: int) -> str:
    """The program of a seed."""
    rng = random.Random(seed)
    if seed % 3:
        return compose(rng)
    data = rng.choice(SOURCES).read_bytes()
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError:
        text = data.decode("gbk")
    return mutate(rng, text)


def run_one(seed: int) -> str:
    """Run the program of a seed to its end or its alarm: "finished", or the alarm's number.

    Raises RuntimeError for an alarm without a place, and whatever else comes out.
    """
    text = program_of(seed)
    rng = random.Random(f"machine {seed}")
    parameters = delivered(rng.choice(["hobbing", "tilted"]), {"3401#0": rng.randint(0, 1)})
    try:
        result = dry_run(parse_program(text), parameters)
    except ControllerError as error:
        alarm = getattr(error, "alarm", None)
        if alarm is None or alarm.span is None:
            raise RuntimeError(f"without a place: {error}") from error
        str(error).encode("utf-8")
        return alarm.number
    for alarm in (*result.alarms, *result.warnings):
        str(alarm).encode("utf-8")
    if result.alarms and result.alarms[0].span is None:
        raise RuntimeError(f"without a place: {result.alarms[0]}")
    return result.alarms[0].number if result.alarms else "finished"


LOW_LIMITS = (
    (interpreter, "LONGEST_STANDSTILL", 2000),
    (flow, "MOST_REPETITIONS", 300),
    (words, "MOST_PASSES", 200),
    (threads, "MOST_PASSES", 200),
)
"""module, name, value: limits against endless programs, low enough that many programs end soon"""


def main() -> int:
    """Run COUNT programs; prints the outcomes and every program that broke something."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 2000
    first = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    for module, name, value in LOW_LIMITS:
        setattr(module, name, value)
    outcomes: dict[str, int] = {}
    broken, slowest, begin = 0, (0.0, 0), time.perf_counter()
    for seed in range(first, first + count):
        start = time.perf_counter()
        try:
            outcome = run_one(seed)
        except Exception:
            broken += 1
            outcome = "BROKEN"
            print(f"--- seed {seed}\n{program_of(seed)!r}\n{traceback.format_exc()}")
        outcomes[outcome] = outcomes.get(outcome, 0) + 1
        slowest = max(slowest, (time.perf_counter() - start, seed))
    seconds = time.perf_counter() - begin
    for name, number in sorted(outcomes.items(), key=lambda pair: -pair[1]):
        print(f"{name:>10} {number}")
    print(
        f"{count} programs in {seconds:.1f} s, {broken} broken, "
        f"slowest {slowest[0]:.2f} s (seed {slowest[1]})"
    )
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
