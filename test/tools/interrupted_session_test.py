#!/usr/bin/python3
"""Which poses a guided session goes on with that was interrupted."""

import unittest
from types import SimpleNamespace

from spherical_actuator_calibration.msg import CoilPattern, PoseProgress
from spherical_actuator_calibration.session_guide.account import Account
from spherical_actuator_calibration.session_guide.options import OptionError, Options
from spherical_actuator_calibration.session_guide.progress import Measured, Pose
from spherical_actuator_calibration.session_guide.session import Session
from spherical_actuator_calibration.session_guide.task import Task


class Bench:
    """A calibration node that plans poses of two coils, holds samples and never estimates; at 2 A."""

    def __init__(self):
        self.held = []
        self._places = {}  # by joint angles
        self.asked = []  # for how many poses
        self.in_force = []  # poses of the plan

    def measured(self):
        return self.held

    @staticmethod
    def parameters():
        return SimpleNamespace(coils=[1, 2])

    def progress_of(self, poses):
        return [self._progress_of(pose) for pose in poses]

    def _progress_of(self, pose):
        there = [sample for sample in self.held if sample.place == self._places.get(pose.joints)]
        patterns = [sample.pattern for sample in there]
        missing = [CoilPattern(coils=list(pattern)) for pattern in pose.excitations if pattern not in patterns]
        return PoseProgress(
            has_sample=bool(there),
            has_current=any(patterns),
            is_measured=bool(there) and not missing,
            missing=missing,
        )

    def begun(self):
        there = zip(self.in_force, self.progress_of(self.in_force))
        return [pose for pose, progress in there if progress.has_sample and not progress.is_measured]

    def plan(self, poses, wanted_stddev, first, **_):
        self.asked.append(poses)
        begin = sum(self.asked[:-1])
        chosen = [Pose((0.1 * n, 0.0, 0.0), ((1,), (2,))) for n in range(begin, begin + poses)]
        self.in_force = [*first, *chosen]
        return chosen, "Planned."

    def capture(self, pose, *patterns):
        place = self._places.setdefault(pose.joints, len(self._places) + 1)
        self.held += [Measured(place, pattern, pose.validation) for pattern in patterns]

    @staticmethod
    def load_plan(_source):
        return [Pose((0.1, 0.0, 0.0), ((1,),))], 1.5


class SessionsOfAPlan(unittest.TestCase):
    @staticmethod
    def session(**options):
        return Session(Bench(), None, Options(validation_poses=0, plan="plan.yaml", **options), Task(), Account())

    def test_take_its_current(self):
        for options in ({}, {"current": 1.5}):
            session = self.session(**options)
            self.assertEqual(len(session._wanted_poses()), 1)
            self.assertEqual(session._course.current, 1.5)

    def test_are_not_made_with_another_one(self):
        self.assertRaisesRegex(OptionError, "plan.yaml has its coils at 1.5 A", self.session(current=1.0)._wanted_poses)


class SamplesThatAreForgottenMeanwhile(unittest.TestCase):
    def test_are_measured_again(self):
        bench, account, led_to = Bench(), Account(), []
        session = Session(bench, None, Options(skip_linearity=True), Task(), account)
        session._look_at_the_joint = lambda: None
        session._course.excite = lambda pattern: None
        session._linearity.captures = lambda pose: 0

        def measure(pose, _which, _done, _further):
            led_to.append(pose)
            if len(led_to) == 2:
                bench.held.clear()
            bench.capture(pose, (), (1,))

        session._course.measure = measure
        poses = [Pose((0.1 * n, 0.0, 0.0), ((1,),)) for n in range(3)]
        session._measure(poses)
        self.assertEqual(led_to, [*poses, poses[0]])
        self.assertIn("Samples of one pose were taken out of use meanwhile", "\n".join(account.message().sentences))


class InterruptedSessions(unittest.TestCase):
    def setUp(self):
        self.bench, self.account = Bench(), Account()

    def wanted(self, **options):
        options = Options(poses=4, validation_poses=0, **options)
        return Session(self.bench, None, options, Task(), self.account)._wanted_poses()

    def test_complete_the_pose_that_was_begun(self):
        first, second, *_ = self.wanted()
        self.bench.capture(first, (), (1,), (2,))
        self.bench.capture(second, ())
        poses = self.wanted()
        self.assertEqual((poses[0], len(poses)), (second, 3))
        self.assertIn("The session goes on: 2 poses are measured already, 1 of them in part.", self.account.message().sentences)
        # Interrupted there once more, in the middle of the coils.
        self.bench.capture(second, (), (1,))
        self.assertEqual(self.wanted()[0], second)
        self.bench.capture(second, (2,))
        self.assertNotIn(second, self.wanted())

    def test_go_on_when_all_poses_were_begun(self):
        for pose in self.wanted():
            self.bench.capture(pose, ())
        self.assertEqual(self.wanted(), self.bench.in_force)
        self.assertEqual(self.bench.asked, [4])

    def test_forget_what_does_not_fit_any_more(self):
        for pose in self.wanted():
            self.bench.capture(pose, ())
        together = [Pose(pose.joints, ((1, -2),)) for pose in self.bench.in_force]
        self.bench.in_force = together
        self.assertEqual(self.wanted(total_current=4.0), together)
        self.assertEqual(self.bench.asked, [4])
        others = self.wanted(total_current=3.0)
        self.assertEqual(len(others), 4)
        self.assertEqual(self.bench.asked, [4, 4])
        self.bench.held.clear()
        self.assertEqual(len(self.wanted()), 4)

    def test_do_not_count_what_the_joint_was_calibrated_by(self):
        for n in range(12):
            self.bench.capture(Pose((0.03, 0.2 * n, 1.0), ()), ())
        self.assertEqual(len(self.wanted()), 4)
        self.assertEqual(self.bench.asked, [4])


if __name__ == "__main__":
    unittest.main()
