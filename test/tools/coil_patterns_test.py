"""Motions that the coils show: where they begin, and how far they go."""

import math
import unittest

import numpy
from spherical_actuator_calibration.coil_drive.patterns import SPIN, TILT, spinning, tilting, turning
from spherical_actuator_calibration.coil_drive.rotations import angle_between, quaternion_of

TIMES = numpy.arange(0.0, 40.0, 0.01)
LARGEST_RATE = 1.5  # [rad/s] of the controller's reference, as shipped
OUTPUT_SHAFT = numpy.array([0.0, 0.0, 1.0])


class Patterns(unittest.TestCase):
    def test_begin_at_the_centre_and_are_followed_within_the_rate(self):
        for pattern in (turning(), tilting(), spinning()):
            rotations = [pattern.rotation(time) for time in TIMES]
            self.assertEqual(angle_between(numpy.eye(3), rotations[0]), 0.0)
            steps = [angle_between(one, other) for one, other in zip(rotations, rotations[1:])]
            self.assertLess(max(steps) / 0.01, LARGEST_RATE)
            for time, rotation in zip(TIMES, rotations):
                self.assertAlmostEqual(pattern.angle_of(rotation), pattern.angle(time), delta=1e-12)
                quaternion_of(rotation)  # can be told

    def test_tilting_moves_the_shaft_and_spinning_does_not(self):
        def tilt(pattern):
            return max(math.acos(min(1.0, pattern.rotation(time)[2] @ OUTPUT_SHAFT)) for time in TIMES)

        self.assertAlmostEqual(tilt(tilting()), TILT, delta=1e-4)
        self.assertEqual(tilt(spinning()), 0.0)
        self.assertAlmostEqual(max(map(spinning().angle, TIMES)), SPIN, delta=1e-4)


if __name__ == "__main__":
    unittest.main()
