"""Chapter on signals."""

from collections.abc import Iterator

from controller.laws.inclined import Frame
from controller.tables.signals import AXIS_LETTERS, MISPRINTS, SIGNALS, Direction, Signal
from twin.manual.entry import Chapter, Entry, spelled

_FRAMES = {
    Frame.SLIDES: "slides: it belongs to the motion of the machine, whatever commanded it",
    Frame.CARTESIAN: "Cartesian: it belongs to the commanded axis",
}


def signals() -> Iterator[Entry]:
    """Every signal, modelled or not."""
    for signal in SIGNALS.values():
        yield Entry(
            chapter=Chapter.SIGNAL,
            name=signal.name("x"),
            title=signal.meaning,
            rows=tuple(_rows(signal)),
            names=frozenset(map(spelled, _names(signal))),
        )


def _rows(signal: Signal) -> Iterator[tuple[str, str]]:
    into = signal.direction is Direction.INPUT
    yield "Direction", "input of the controller" if into else "output of the controller"
    if signal.per_axis:
        yield "Axes", f"one for each axis, as {signal.name('X')}"
    if into and signal.modelled:
        yield "Supported", f"yes: --signal {signal.name('X')}=0 or 1, {int(signal.idle)} unless set"
    elif signal.modelled:
        yield "Supported", "yes: its level at the end is reported"
    else:
        yield "Supported", f"no; instead: {signal.instead}"
    if signal.frame:
        yield "Frame", _FRAMES[signal.frame]
    if signal.address:
        yield "Address", signal.address
    yield "Clause", signal.clause


def _names(signal: Signal) -> Iterator[str]:
    yield signal.name("x")
    yield signal.name("x").lstrip("*")
    for letter in AXIS_LETTERS if signal.per_axis else ():
        yield signal.name(letter)
        yield signal.name(letter).lstrip("*")
    for misprint, name in MISPRINTS.items():
        if name == signal.pattern:
            yield misprint
