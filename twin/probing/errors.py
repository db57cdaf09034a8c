"""What a measurement by touch may find that stops it."""

from twin.errors import HobtwinError


class ProbingError(HobtwinError):
    """The touches tell of no circle that could be compensated: exit code 1, with the figures."""
