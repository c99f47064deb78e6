#!/usr/bin/python3
"""How a guided session measures one coil at three currents in one rest, as the node says, without ROS."""

import unittest
from types import SimpleNamespace

from spherical_actuator_calibration.msg import CoilPattern
from spherical_actuator_calibration.session_guide.account import Account
from spherical_actuator_calibration.session_guide.linearity import LinearityTest
from spherical_actuator_calibration.session_guide.options import Options
from spherical_actuator_calibration.session_guide.pose_course import PoseCourse
from spherical_actuator_calibration.session_guide.progress import Pose
from spherical_actuator_calibration.srv import LinearityCapturesResponse

FULL = 2.0  # [A]
POSE = Pose((0.1, 0.0, 0.0), ((3,), (5,)))
WANTED = [((5,), 0.5 * FULL), ((-5,), FULL)]


class Bench:
    """A calibration node that lacks captures of coil 5 in the last rest at one pose; rests are interrupted before the captures
    of `interrupted`."""

    def __init__(self, interrupted=(), captures=2):
        self.captured = []
        self._held = []  # in the last rest
        self._interrupted = set(interrupted)
        self._captures = captures

    def linearity_captures(self, pose, current):
        assert (pose, current) == (POSE, FULL)
        missing = [] if not self._captures else [one for one in WANTED if one not in self._held]
        return LinearityCapturesResponse(
            captures=self._captures if missing else 0,
            patterns=[CoilPattern(coils=list(pattern)) for pattern, _ in missing],
            currents=[current for _, current in missing],
        )

    def capture(self, current, pose, pattern):
        assert pose is POSE
        if len(self.captured) in self._interrupted:
            self._held = []
        self.captured.append((pattern, current))
        self._held.append((pattern, current))


class OneCoilAtThreeCurrents(unittest.TestCase):
    def measured(self, bench, is_wanted=True):
        """Number of captures that were announced, and that were counted."""
        account = Account()
        course = PoseCourse(bench, SimpleNamespace(), Options(), None, account)
        course.capture = lambda pose, pattern: bench.capture(course.current, pose, pattern)
        linearity = LinearityTest(bench, course, account, is_wanted)
        announced = linearity.captures(POSE)
        counted = []
        linearity.measure(POSE, lambda: counted.append(True))
        self.assertEqual(course.current, FULL)
        self.said = "".join(account.message().sentences)
        return announced, len(counted)

    def test_are_those_that_the_node_lacks(self):
        bench = Bench()
        self.assertEqual(self.measured(bench), (2, 2))
        self.assertEqual(bench.captured, WANTED)
        self.assertEqual(self.measured(bench), (0, 0))

    def test_of_an_interrupted_rest_are_measured_anew(self):
        bench = Bench(interrupted=(1,))
        self.measured(bench)
        self.assertEqual(bench.captured, [*WANTED, WANTED[0]])
        self.assertEqual(self.said, "")

    def test_of_rests_that_are_always_interrupted_are_left_to_the_next_pose(self):
        bench = Bench(interrupted=range(1, 99))
        self.measured(bench)
        self.assertLess(len(bench.captured), 10)
        self.assertIn("the next pose", self.said)

    def test_are_left_out_where_they_are_not_to_be_or_not_wanted(self):
        self.assertEqual(self.measured(Bench(), is_wanted=False), (0, 0))
        self.assertEqual(self.measured(Bench(captures=0)), (0, 0))


if __name__ == "__main__":
    unittest.main()
