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
}


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


def reading() -> Iterator[dict[str, object]]:
    """One result a kind of block."""
    machine = machine_data(delivered("hobbing"))
    motion = standing_motion(len(machine.axes))
    for kind, line in KINDS.items():
        text = "\n".join(["#1=5.5", "#2=-1.25", *map(line, range(BLOCKS)), "M30"])
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
