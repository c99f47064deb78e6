#!/usr/bin/python3
"""What is said of a motion while it goes on, and when that is enough."""

import unittest

from spherical_actuator_calibration.coil_drive.motion_progress import ProgressWatch
from spherical_actuator_calibration.msg import GroupUncertainty, MotionProgress


def progress(duration, joints, poles, coils, **others):
    names = (("joints", "joint_3/offset"), ("poles", "pole_2/polar"), ("coils", "coil_7/azimuth"))
    known = list(zip(names, (joints, poles, coils)))
    groups = [GroupUncertainty(group, name, stddev, 9, int(stddev > 1e-4)) for (group, name), stddev in known]
    fields = {"told": True, "windows": 51, "message": f"{duration:.0f} s of motion.", "wanted_stddev": 1e-4, **others}
    return MotionProgress(duration=duration, groups=groups, **fields)


class Watch(unittest.TestCase):
    def setUp(self):
        self.said = []
        self.ended = 0

    def watch(self, wanted, *messages):
        """Its end, after it has seen each of them twice."""

        def enough():
            self.ended += 1

        watch = ProgressWatch("/actuator", self.said.append, wanted, enough)
        for message in messages:
            watch.receive(message)
            watch.look()
            watch.look()
        return watch.end()

    def test_ends_the_motion_once_it_is_enough(self):
        enough = progress(13.0, 5e-5, 5e-5, 5e-5, is_enough=True)
        self.assertTrue(self.watch(1e-4, progress(12.0, 5e-5, 2e-4, 3e-4), enough, progress(13.2, 2e-4, 5e-5, 5e-5)))
        self.assertEqual(self.ended, 1)
        self.assertEqual(len(self.said), 2)

    def test_without_a_wish_it_only_tells(self):
        self.assertTrue(self.watch(None, progress(12.0, 5e-5, 5e-5, 5e-5, is_enough=True), progress(14.0, 5e-5, 5e-5, 5e-5)))
        self.assertEqual(self.ended, 0)
        self.assertEqual(len(self.said), 1)

    def test_tells_that_it_was_not_reached(self):
        self.assertFalse(self.watch(1e-4, progress(12.0, 5e-5, 2e-4, 3e-4)))
        self.assertIn("ended before that was reached. 12 s of motion", self.said[-1])
        self.assertFalse(self.watch(1e-4, progress(0.0, 1.0, 1.0, 1.0, told=False)))
        self.assertIn("before anything was known", self.said[-1])


if __name__ == "__main__":
    unittest.main()
