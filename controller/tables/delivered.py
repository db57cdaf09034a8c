"""The values of all parameters as the machine is delivered, for either set-up (rulings, section 0)."""

from controller.tables.parameter_table import FAR, SWITCH_NUMBERS

SETUPS = ("hobbing", "tilted")
_AXIS = {str(number): 0.0 for number in (1240, 1241, 1242, 1243, 1322, 1323, 1324, 1325)} | {
    "1421": 500.0,
    "1423": 2000.0,
    "9005": 0b10,
}
_ROTARY = _AXIS | {"1006": 0b1, "1022": 0, "1310": 0, "1420": 36000.0, "1430": 36000.0, "1660": 3600.0}
_SLIDE = _AXIS | {
    "1006": 0,
    "1022": 0,
    "1310": 0b11,  # areas 2 and 3 are checked as soon as they are more than nothing
    "1420": 12000.0,
    "1430": 8000.0,
    "1660": 2000.0,
    "3772": 0.0,
}
_X = _SLIDE | {"1006": 0b1000, "1022": 1, "1320": 640.0, "1321": -640.0}
_Z = _SLIDE | {"1022": 3, "1320": 400.0, "1321": -800.0, "1420": 15000.0}
_TOOL = _ROTARY | {"3772": 4000.0, "1320": FAR, "1321": -FAR}
_WORK = _ROTARY | {"3772": 2000.0, "1320": FAR, "1321": -FAR}
_TILTED_Y = _SLIDE | {"1022": 2, "1320": 320.0, "1321": -320.0}
_COMMON: dict[int, float] = {
    201: 0,
    198: 4,
    199: 2,
    1300: 0,
    1301: 0,
    1410: 2000,
    3401: 1,
    3410: 0.01,
    5002: 0,
    8200: 0,
    8201: 0,
    8209: 0,
    9001: 4,
    9003: -1,
    9004: 5,
    9006: 0,
    **dict.fromkeys(SWITCH_NUMBERS, 0),
}
DELIVERED: dict[str, tuple[dict[int, float], dict[str, dict[str, float]]]] = {
    "hobbing": (
        _COMMON | {197: 3, 8210: 0, 8211: 0, 8212: 0, 9002: 3},
        {"X": _X, "Z": _Z, "Y": _TOOL, "C": _WORK},
    ),
    "tilted": (
        _COMMON | {197: 5, 8210: -30000, 8211: 3, 8212: 1, 9002: 5},
        {"X": _X, "Z": _Z, "Y": _TILTED_Y, "C": _WORK, "B": _TOOL},
    ),
}
