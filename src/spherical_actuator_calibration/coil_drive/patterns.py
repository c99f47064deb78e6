"""Motions that show what the actuator does: turns about one axis of the stator over the time. No ROS."""

import dataclasses
import math
from typing import Callable

import numpy

from .rotations import rotation_exp

X, Z = 0, 2
SPEED = math.pi / 48.0  # [rad/s] of the paper's Figure 14
TILT, TILT_PERIOD = 0.3, 6.0  # [rad], [s]
SPIN, SPIN_PERIOD = 2.5, 20.0  # [rad] less than half a turn either way; [s]


@dataclasses.dataclass(frozen=True)
class Pattern:
    axis: int  # of the stator, counted from 0
    angle: Callable[[float], float]  # [rad] at a time [s]; zero at zero

    def rotation(self, time):
        """Rotor to stator."""
        return rotation_exp(self.angle(time) * numpy.eye(3)[self.axis])

    def angle_of(self, rotation):
        """Angle [rad] of a rotation that is nearly one about the axis."""
        one, other = (self.axis + 1) % 3, (self.axis + 2) % 3
        return float(numpy.arctan2(rotation[other, one], rotation[one, one]))


def turning(speed=SPEED):
    """About x at a constant speed [rad/s], as in the paper's section 4.3.3."""
    return Pattern(X, lambda time: speed * time)


def tilting():
    """The output shaft to and fro about x, as in the paper's Figure 2."""
    return Pattern(X, lambda time: TILT * math.sin(2.0 * math.pi * time / TILT_PERIOD))


def spinning():
    """The rotor to and fro about its output shaft, as in the paper's Figure 2."""
    return Pattern(Z, lambda time: SPIN * math.sin(2.0 * math.pi * time / SPIN_PERIOD))
