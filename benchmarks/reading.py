"""How fast programs are read: lexing and interpreting alone, with a motion that stands still."""

import time
from collections.abc import Callable, Iterator
from types import SimpleNamespace
from typing import cast

from controller.language.interpreter import Interpreter
from controller.language.offsets import Offsets
from controller.language.source import parse_program
from controller.motion.motion import Motion
from controller.tables.machine_data import machine_data
from controller.tables.parameters import delivered

BLOCKS = 100_000
KINDS: dict[str, Callable[[int], str]] = {
    "plain": lambda n: f"N{n} G01 X{10 + n % 7}.123 Z-{n % 90}.2 F100.",
    "other order": lambda n: f"N{n} G01 Z-{n % 90}.2 X{10 + n % 7}.123 F100.",
    "arcs": lambda n: f"N{n} G02 X{n % 7}. Z-{1 + n % 90}.2 R500. F100.",
    "expressions": lambda n: f"N{n} G01 X#1 Z[#2-{n % 90}.2] F100.",
    "mixed": lambda n: f"{MIXED[n % len(MIXED)]} (block {n})" if n % 10 == 0 else MIXED[n % len(MIXED)],
}
MIXED = """N10 G00 X40.5 Z2.
N20 G01 Z-1.25 F180.
X32.005 Z-2.75
Z-12.5
(finish)
N30 G02 U4. W-2. R2.
N40 G1 F120. X44.75 Z-18.125
N50 G03 U4. W-2. K-2.
G01 X 48. Z -20.5
Z-21. X47.5
N60 X46.25 F90.
W-1.5
U-0.5 W-0.25
G00 X60.
Z2.""".splitlines()
"""what a CAM system writes: contours with arcs, changes of feed, comments, words in other orders"""


def standing_motion(axes: int) -> Motion:
    """What the interpreter looks at, without planning."""
    return cast(
        Motion,
        SimpleNamespace(
            time=0.0,
            registers=SimpleNamespace(absolute=[0.0] * axes),
            references=SimpleNamespace(require=lambda *_: None),
            spindles=SimpleNamespace(free=set(), turning=lambda *_: False),
        ),
    )


def program_of(kind: str, blocks: int) -> str:
    """A program of so many blocks of one kind."""
    return "\n".join(["#1=5.5", "#2=-1.25", *map(KINDS[kind], range(blocks)), "M30"])


def reading() -> Iterator[dict[str, object]]:
    """One result a kind of block."""
    machine = machine_data(delivered("hobbing"))
    motion = standing_motion(len(machine.axes))
    for kind in KINDS:
        text = program_of(kind, BLOCKS)
        start = time.perf_counter()
        program = parse_program(text, file="bench.nc")
        interpreter = Interpreter(program, machine, Offsets(), {})
        while interpreter.next(motion):
            interpreter.moved()
        seconds = time.perf_counter() - start
        yield {
            "case": "reading",
            "kind": kind,
            "blocks": BLOCKS,
            "seconds": seconds,
            "blocks_per_s": BLOCKS / seconds,
        }
