"""How far, how fast and with what acceleration the axes have gone. Lists have one entry an axis."""

from collections.abc import Mapping, Sequence


class Extents:
    """The smallest and the largest position each axis has had."""

    __slots__ = ("high", "low")

    def __init__(self, position: Sequence[float]) -> None:
        self.low = list(position)
        self.high = list(position)

    def start(self, position: Sequence[float]) -> None:
        """Begin anew at a position (axes,)."""
        self.low[:] = self.high[:] = position

    def include(self, position: Sequence[float]) -> None:
        """Another position (axes,)."""
        for axis, value in enumerate(position):
            self.stretch(axis, value)

    def stretch(self, axis: int, value: float) -> None:
        """Another position of one axis."""
        if value < self.low[axis]:
            self.low[axis] = value
        elif value > self.high[axis]:
            self.high[axis] = value


class Peaks:
    """The highest speed and acceleration each axis has had."""

    __slots__ = ("acceleration", "speed")

    def __init__(self, axes: int) -> None:
        self.speed = [0.0] * axes
        self.acceleration = [0.0] * axes

    def note(self, shares: Mapping[int, float], speed: float, acceleration: float) -> None:
        """Axes have gone along a path of this speed and acceleration; `shares`: column -> travel per path."""
        for axis, share in shares.items():
            self.speed[axis] = max(self.speed[axis], abs(share) * speed)
            self.acceleration[axis] = max(self.acceleration[axis], abs(share) * acceleration)
