"""The table of advice: one row a kind, numbered HT9200 ff., in the form of the controller's alarm table."""

from dataclasses import dataclass
from enum import Enum


class Weight(Enum):
    """A warning says that the part will not be the one that is wanted, a note that it could be better."""

    WARNING = "warning"
    NOTE = "note"


class Kind(Enum):
    """What there is to advise about."""

    INSERTS = "HT9200"
    SIDES = "HT9201"
    CONCAVE = "HT9202"
    CONVEX = "HT9203"
    ACROSS_FLATS = "HT9204"
    TWISTED = "HT9205"
    TOOL = "HT9210"
    HOB = "HT9211"
    SWIVEL = "HT9212"
    UNKNOWN_TOOL = "HT9213"
    TEETH = "HT9220"
    STARTS = "HT9221"
    HAND_OF_HOB = "HT9222"
    HELIX_MISSING = "HT9223"
    HELIX_UNWANTED = "HT9224"
    HAND_OF_GEAR = "HT9225"
    HELIX_ANGLE = "HT9226"
    MODULE = "HT9227"
    CHANGED_TURNING = "HT9230"
    REVERSED = "HT9231"
    RELEASED = "HT9232"
    RAPID = "HT9240"
    OUT_OF_SYNC = "HT9241"
    STANDSTILL = "HT9242"
    DEPTH = "HT9250"
    FACE_NOT_COVERED = "HT9251"
    NOTHING_CUT = "HT9252"
    FEED_MARKS = "HT9260"
    GENERATING_FLATS = "HT9261"
    CUTTING_SPEED = "HT9262"


@dataclass(frozen=True, slots=True, kw_only=True)
class KindEntry:
    """One row of the table."""

    kind: Kind
    text: str
    remedy: str
    """what mends it in general"""
    clause: str
    weight: Weight = Weight.WARNING


_HOB = "geometry.md, section 2"
_HEAD = "geometry.md, section 3"
_G81 = "hobbing, 代码说明"
_G51_2 = "polygon, 代码说明"

_ROWS = (
    ("INSERTS", "P IS NOT THE NUMBER OF INSERTS", "P as many as inserts are mounted", _G51_2),
    ("SIDES", "THE SIDES CUT ARE NOT THOSE WANTED", "Q/P = sides / inserts", "rulings, section 3"),
    ("CONCAVE", "CONCAVE FACES", "Q/P = 2: half as many inserts as sides", _HEAD),
    ("CONVEX", "FACES MORE CONVEX THAN THE TOLERANCE", "a larger tip radius of the head", _HEAD),
    ("ACROSS_FLATS", "WIDTH ACROSS FLATS OUT OF TOLERANCE", "X of the finishing pass = width", "ISO 4759-1"),
    ("TWISTED", "A LEAD WHERE A STRAIGHT POLYGON IS WANTED", "G51.2 without A", "rulings, section 3"),
    (
        "TOOL",
        "THE TOOL DOES NOT FIT THE GEAR BOX",
        "G81 with a hob, G51.2 with a polygon head",
        "rulings, section 0",
    ),
    ("HOB", "THE HOB DOES NOT FIT THE GEAR", "a hob of the gear's module and pressure angle", _HOB),
    ("SWIVEL", "SWIVEL DOES NOT FIT HOB AND GEAR", "swivel = helix angle - lead angle, both signed", _HOB),
    ("UNKNOWN_TOOL", "A TOOL THAT THE JOB DOES NOT HAVE", "T of a tool of the job", "design, job.toml"),
    ("TEETH", "T IS NOT THE NUMBER OF TEETH", "T = teeth wanted, L = starts of the hob", _G81),
    ("STARTS", "L IS NOT THE NUMBER OF STARTS", "L = starts of the hob", _G81),
    (
        "HAND_OF_HOB",
        "L AGAINST THE HAND OF THE HOB",
        "L > 0 with a right-hand hob, else L < 0",
        "design, job.toml",
    ),
    ("HELIX_MISSING", "NO HELICAL COMPENSATION", "Q and P in G81", "hobbing, 斜齿轮加工"),
    ("HELIX_UNWANTED", "HELICAL COMPENSATION OF A SPUR GEAR", "G81 without Q and P", "hobbing, 斜齿轮加工"),
    ("HAND_OF_GEAR", "P AGAINST THE HAND OF THE GEAR", "P > 0 for a right-hand gear", "rulings, section 2"),
    ("HELIX_ANGLE", "P IS NOT THE HELIX ANGLE", "P = helix angle of the gear", "rulings, section 2"),
    ("MODULE", "Q IS NOT THE NORMAL MODULE", "Q = normal module of the gear", "hobbing, 注 5"),
    ("CHANGED_TURNING", "GEAR BOX CHANGED WHILE TURNING", "S0 before G81 or G51.2", "hobbing, 注意事项"),
    ("REVERSED", "S REVERSED IN THE CUT", "retract before S changes its sign", "rulings, section 2"),
    ("RELEASED", "GEAR BOX RELEASED IN THE CUT", "retract, S0, then G80 or G50.2", "hobbing, 编程示例"),
    ("RAPID", "RAPID INTO THE STOCK", "G01 with a feed, or a path outside the stock", "rulings, section 0"),
    ("OUT_OF_SYNC", "FEED INTO THE STOCK WITHOUT GEAR BOX", "G81 or G51.2 before", "rulings, sections 2, 3"),
    ("STANDSTILL", "FEED INTO THE STOCK WITH THE TOOL AT REST", "S in sync, before", "hobbing, 同步过程中"),
    ("DEPTH", "TEETH NOT TO DEPTH", "X of the last pass = root diameter", "rulings, section 0"),
    ("FACE_NOT_COVERED", "FACE WIDTH NOT COVERED", "Z past both ends by the run-out of the hob", _HOB),
    ("NOTHING_CUT", "THE TOOL NEVER MEETS THE STOCK", "feed moves into the blank", "rulings, section 0"),
    ("FEED_MARKS", "COARSE FEED MARKS", "a smaller feed per turn of the work", _HOB),
    ("GENERATING_FLATS", "COARSE GENERATING FLATS", "a hob with more gashes or fewer starts", _HOB),
    ("CUTTING_SPEED", "UNUSUAL CUTTING SPEED", "S for 40 to 140 m/min", "geometry.md, section 6"),
)
_NOTES = frozenset({Kind.CUTTING_SPEED})

KINDS: dict[Kind, KindEntry] = {
    Kind[name]: KindEntry(
        kind=Kind[name],
        text=text,
        remedy=remedy,
        clause=clause,
        weight=Weight.NOTE if Kind[name] in _NOTES else Weight.WARNING,
    )
    for name, text, remedy, clause in _ROWS
}
"""Every kind of advice."""
