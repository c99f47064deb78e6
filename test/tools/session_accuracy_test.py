#!/usr/bin/python3
"""A guided session ends when its parameters are as good as wanted, without ROS."""

import math
import unittest
from types import SimpleNamespace

from spherical_actuator_calibration.session_guide import progress
from spherical_actuator_calibration.session_guide.options import Options
from spherical_actuator_calibration.session_guide.session import Session

AT_ZERO = progress.Pose((0.0, 0.0, 0.0), ())


class Rehearsal(Session):
    """A session whose parameters get better with every pose by the root of their number; one pose is as good as one
    milliradian."""

    def __init__(self, **options):
        self.said = []
        self.poses = 0
        account = SimpleNamespace(say=self.said.append, set=lambda **fields: None)
        super().__init__(self, None, Options(validation_poses=0, **options), None, account)

    # What it asks its calibration node.
    def begun(self):
        return []  # of no earlier plan

    def plan(self, poses, wanted_stddev, **_excitation):
        expected = round((0.5e-3 / wanted_stddev) ** 2) if wanted_stddev else poses
        return [AT_ZERO] * min(poses, expected), "as planned"

    def status(self):
        worst = 1e-3 / math.sqrt(max(1, self.poses))
        return SimpleNamespace(worst_stddev=worst, shortest_capture=0.2, longest_capture=60.0)

    # What it does beside.
    def _measure(self, poses):
        self.poses += len(poses)

    def _training_poses(self, _interrupted=()):
        return self.poses

    def _estimate(self):
        return True

    def _conclude(self):
        return True

    def wait_until_up(self):
        self._course.require_current = lambda poses: None


class WantedAccuracy(unittest.TestCase):
    def session(self, **options):
        session = Rehearsal(**options)
        session._measure(session._plan(session._options.poses, session._options.wanted_stddev))
        session._reach_wanted_stddev()
        return session

    def test_ends_a_session_only_when_it_is_reached(self):
        # Expected after four poses, reached after sixteen.
        session = self.session(poses=40, wanted_stddev=0.25e-3)
        self.assertEqual(session.poses, 16)
        self.assertIn("0.5 mrad, 0.25 mrad wanted: 2 poses are added", session.said[1])
        self.assertIn("0.25 mrad wanted: that is reached", session.said[-1])

    def test_is_planned_by_the_noise_that_the_first_pose_has(self):
        class Quiet(Rehearsal):
            def plan(self, poses, wanted_stddev, **_excitation):
                return [AT_ZERO] * (3 if self.poses else poses), "as planned"

        session = Quiet(poses=40, wanted_stddev=0.5e-3)
        self.assertTrue(session.run())
        self.assertEqual(session.poses, 4)
        session = Quiet(poses=40)
        session.run()
        self.assertEqual(session.poses, 40)

    def test_ends_where_poses_fall_on_earlier_ones(self):
        class Repeated(Rehearsal):
            def _training_poses(self, _interrupted=()):
                return 1

        session = Repeated(poses=5, wanted_stddev=1e-6)
        session._measure(range(1))
        session._reach_wanted_stddev()
        self.assertIn("that takes more than 5 poses", session.said[-1])

    def test_takes_no_more_poses_than_were_asked_for(self):
        session = self.session(poses=7, wanted_stddev=0.25e-3)
        self.assertEqual(session.poses, 7)
        self.assertIn("1 pose is added", "".join(session.said))
        self.assertIn("that takes more than 7 poses", session.said[-1])


if __name__ == "__main__":
    unittest.main()
