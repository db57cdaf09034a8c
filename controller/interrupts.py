"""What ends a program from outside: RESET, the emergency stop, an operator who never comes."""


class Interrupt(Exception):
    """The program goes no further."""


class Reset(Interrupt):
    """RESET has been pressed, and the motion has come to rest."""


class EmergencyStop(Interrupt):
    """Everything has been stopped."""


class LeftStanding(Interrupt):
    """The program waits for an operator of whom nothing more is to come; `str()` says at what."""
