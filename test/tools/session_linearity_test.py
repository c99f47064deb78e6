#!/usr/bin/python3
"""How a guided session measures one coil at three currents in one rest, without ROS."""

import dataclasses
import unittest
from collections import Counter
from types import SimpleNamespace

from spherical_actuator_calibration.msg import PoseProgress
from spherical_actuator_calibration.session_guide.account import Account
from spherical_actuator_calibration.session_guide.linearity import LinearityTest
from spherical_actuator_calibration.session_guide.options import Options
from spherical_actuator_calibration.session_guide.pose_course import PoseCourse
from spherical_actuator_calibration.session_guide.progress import Measured, Pose

FULL = 2.0  # [A]
POSE = Pose((0.1, 0.0, 0.0), ((3,), (5,)))
PATTERNS = Pose((0.1, 0.0, 0.0), ((3, -5), (4, 6)))


class Bench:
    """A calibration node that holds samples, each place by the first joint angle of its pose; rests are interrupted before the captures of `interrupted`."""

    def __init__(self, held, interrupted=(), least_current=0.09):
        self.held = [dataclasses.replace(sample, number=n) for n, sample in enumerate(held, 1)]
        self.rest = max((sample.rest for sample in held), default=1.0)
        self.captured = []
        self._interrupted = set(interrupted)
        self._least_current = least_current

    def status(self):
        return SimpleNamespace(least_current=self._least_current, linearity_is_told=self._is_told())

    def _is_told(self):
        """As the node counts: by one coil at three currents in one rest."""
        alone = {(s.rest, abs(s.pattern[0]), s.pattern, round(s.current, 1)) for s in self.held if s.rest and len(s.pattern) == 1}
        counts = Counter(key[:2] for key in alone)
        return max(counts.values(), default=0) >= 3

    def measured(self):
        return self.held

    def progress_of(self, poses):
        return [PoseProgress(samples=[s.number for s in self.held if is_of(s, pose)]) for pose in poses]

    def capture(self, current, pose, pattern):
        if len(self.captured) in self._interrupted:
            self.rest += 1.0
        self.captured.append((pattern, current))
        # What is measured is not quite what was commanded.
        self.held.append(Measured(len(self.held) + 1, pose.joints[0], pattern, False, 1.03 * current, 0.1, self.rest))


def is_of(measured, pose):
    """Whether it counts for the pose."""
    return (measured.place, measured.validation) == (pose.joints[0], pose.validation)


def sample(pattern, torque=0.1, current=FULL, rest=1.0, joints=POSE.joints, validation=False):
    return Measured(0, joints[0], pattern, validation, current, torque, rest)


SINGLY = (sample((), current=0.0), sample((3,), torque=0.2), sample((5,), torque=0.4))


class OneCoilAtThreeCurrents(unittest.TestCase):
    def measured(self, bench, pose=POSE, is_wanted=True):
        """Number of captures that were announced, and that were counted."""
        account = Account()
        course = PoseCourse(bench, bench, Options(), None, account)
        course.capture = lambda pose, pattern: bench.capture(course.current, pose, pattern)
        linearity = LinearityTest(bench, course, account, is_wanted)
        announced = linearity.captures(pose)
        counted = []
        linearity.measure(pose, lambda: counted.append(True))
        self.assertEqual(course.current, FULL)
        self.said = "".join(account.message().sentences)
        return announced, len(counted)

    def test_is_the_one_that_makes_most_torque(self):
        bench = Bench(SINGLY)
        self.assertEqual(self.measured(bench), (2, 2))
        self.assertEqual(bench.captured, [((5,), 0.5 * FULL), ((-5,), FULL)])

    def test_is_measured_once(self):
        bench = Bench(SINGLY)
        self.measured(bench)
        self.assertEqual(self.measured(bench), (0, 0))
        elsewhere = Bench([*bench.held, sample((5,), rest=2.0, joints=(0.3, 0.0, 0.0))])
        self.assertEqual(self.measured(elsewhere, Pose((0.3, 0.0, 0.0), ((5,),))), (0, 0))

    def test_where_patterns_are_of_several_coils_is_measured_alone(self):
        held = [sample((), current=0.0), sample((3, -5), torque=0.2), sample((4, 6), torque=0.3)]
        bench = Bench(held)
        self.assertEqual(self.measured(bench, PATTERNS), (3, 3))
        self.assertEqual(bench.captured, [((4,), FULL), ((4,), 0.5 * FULL), ((-4,), FULL)])

    def test_of_an_interrupted_rest_is_measured_anew(self):
        bench = Bench(SINGLY, interrupted=(1,))
        self.measured(bench)
        self.assertEqual(bench.captured[2:], [((5,), FULL), ((5,), 0.5 * FULL)])
        self.assertEqual({s.rest for s in bench.held[-3:]}, {2.0})
        self.assertEqual(self.said, "")

    def test_of_rests_that_are_always_interrupted_is_left_to_the_next_pose(self):
        bench = Bench(SINGLY, interrupted=range(1, 99))
        self.measured(bench)
        self.assertLess(len(bench.captured), 10)
        self.assertIn("the next pose", self.said)
        self.assertEqual(self.measured(Bench(bench.held))[0], 2)

    def test_is_left_out_where_it_cannot_be_or_is_not_wanted(self):
        self.assertEqual(self.measured(Bench(SINGLY), is_wanted=False), (0, 0))
        self.assertEqual(self.measured(Bench(SINGLY, least_current=1.01)), (0, 0))
        self.assertEqual(self.measured(Bench(SINGLY), Pose(POSE.joints, ())), (0, 0))
        self.assertEqual(self.measured(Bench(SINGLY), Pose(POSE.joints, POSE.excitations, True)), (0, 0))
        self.assertEqual(self.measured(Bench([])), (2, 0))

    def test_samples_of_rests_that_are_not_known_tell_nothing(self):
        old = [sample((5,), rest=0.0), sample((5,), current=0.5 * FULL, rest=0.0), sample((-5,), rest=0.0)]
        self.assertEqual(self.measured(Bench([*old, *SINGLY])), (2, 2))


if __name__ == "__main__":
    unittest.main()
