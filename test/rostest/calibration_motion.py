#!/usr/bin/python3
"""calibrate_motion of the running node, by the streams of a free rotor that the package did not simulate."""

import os
import pathlib
import sys
import tempfile
import unittest

import rospy
import rostest
from calibration_client import (
    NAMESPACE,
    PACKAGE,
    CalibrationClient,
    CalibrationNode,
    Reception,
    play,
    stop_player,
    values_of,
    wait_for,
)

# Its laboratory is shared with the tests of independent data.
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "independent"))
import free_motion  # noqa: E402
import laboratory  # noqa: E402
import numpy as np  # noqa: E402
from motion_bag import write_bag  # noqa: E402
from spherical_actuator_calibration.msg import MotionProgress  # noqa: E402

SECONDS = 10.0
SEED = 8
RATE = 200.0  # [Hz]
WANTED = 2e-4  # [rad]
WISH = 3e-4  # [rad] of the first motion


class LiveMotion(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.client = CalibrationClient()
        self.node = CalibrationNode(os.path.join(self.folder.name, "calibration"), diagnostic_period=0.1, motion_wanted_stddev=WANTED)
        self.addCleanup(self.node.stop)

    def record(self):
        """Draws a unit, and records its motion; returns the bag and the number of its messages by stream."""
        self.unit = laboratory.paper_unit()
        self.errors = np.random.default_rng(SEED).uniform(-0.03, 0.03, self.unit.size())
        motion = free_motion.simulate(self.unit, self.errors, free_motion.Machine(), SECONDS, SEED)
        streams = free_motion.Streams(joint_rate=RATE, current_rate=RATE)
        bag = os.path.join(self.folder.name, "motion.bag")
        recording = free_motion.record(self.unit, self.errors, motion, streams, SEED)
        return bag, write_bag(bag, recording, len(self.unit.coils))

    def listen(self, bag, counts):
        """Lets the node hear a recording to its end."""
        reception = Reception(self.client, counts)
        player = play(bag)
        self.addCleanup(stop_player, player)
        wait_for(lambda: sum(self.client.received("joint_states")), "the first measurements")
        wait_for(lambda: not reception.is_going_on(), "the last measurements")

    def expect_the_truth(self, report):
        estimates = {estimate.name: estimate for estimate in report.estimates}
        rows = [estimates[name] for name in self.unit.names()]
        self.assertTrue(all(row.observable for row in rows))
        apart = np.array([row.value for row in rows]) - self.unit.values(self.errors)
        apart = (apart + np.pi) % (2.0 * np.pi) - np.pi
        normalised = np.sqrt(np.mean((apart / [row.stddev for row in rows]) ** 2))
        self.assertGreater(normalised, 0.5)
        self.assertLess(normalised, 1.6)
        self.assertLess(max(abs(apart)), 1e-3)

    def expect_progress(self, least_windows=0):
        """What was told while it moved, after so many windows or more."""
        told = []
        subscriber = rospy.Subscriber(f"{NAMESPACE}/motion_progress", MotionProgress, told.append)
        self.addCleanup(subscriber.unregister)
        wait_for(lambda: told and told[-1].duration > 0.8 * SECONDS, "the last windows")
        wait_for(lambda: told[-1].windows >= least_windows, "those of before")
        progress = told[-1]
        self.assertTrue(progress.told)
        self.assertEqual([group.group for group in progress.groups], ["joints", "poles", "coils"])
        self.assertEqual([group.parameters for group in progress.groups], [9, 16, 48])
        worst = max(group.stddev for group in progress.groups)
        self.assertLess(worst, 1e-3)
        self.assertEqual(progress.wanted_stddev, WISH)
        self.assertAlmostEqual(progress.time_left, progress.duration * max(0.0, (worst / WISH) ** 2 - 1.0), places=6)
        for group in progress.groups:
            self.assertEqual(group.left == 0, group.stddev <= WISH)
            self.assertIn(group.group[:-1], group.least_known)
        dynamics = {one.name: one for one in progress.dynamics}
        inertia = dynamics["rotor_inertia/xx"]
        self.assertLess(abs(inertia.value - free_motion.Machine().inertia[0, 0]), 6.0 * inertia.stddev)
        return progress

    def expect_wishes(self):
        """A motion begins with a wish that can be, or with that of the node."""
        told = []
        subscriber = rospy.Subscriber(f"{NAMESPACE}/motion_progress", MotionProgress, told.append)
        self.addCleanup(subscriber.unregister)
        wait_for(lambda: told, "the progress")
        before = told[-1]
        for wrong in (-1e-4, float("nan"), 2.0):
            refused = self.client.call("begin_motion", wanted_stddev=wrong)
            self.assertFalse(refused.success)
            self.assertIn("wanted_stddev", refused.message)
        self.assertEqual(told[-1].windows, before.windows)
        for wish, wanted in ((5e-5, 5e-5), (0.0, WANTED)):
            self.assertTrue(self.client.call("begin_motion", wanted_stddev=wish).success)
            wait_for(lambda wanted=wanted: told[-1].wanted_stddev == wanted, "the wish")
            self.assertEqual(told[-1].windows, 0)
            self.assertFalse(told[-1].is_enough)

    def test_motion_gives_parameters_that_outlive_the_node(self):
        self.client.start(self.node)
        refused = self.client.call("calibrate_motion")
        self.assertFalse(refused.success)
        self.assertIn("No motion is recorded", refused.message)
        self.assertTrue(self.client.call("begin_motion", wanted_stddev=WISH).success)
        self.listen(*self.record())
        before = self.expect_progress()
        # The session database has kept the windows as they came, a parameter what is wanted of them.
        self.node.kill()
        self.client.start(self.node)
        after = self.expect_progress(before.windows)
        for one, other in zip(before.groups, after.groups):
            self.assertAlmostEqual(one.stddev / other.stddev, 1.0, delta=0.1)
        answer = self.client.call("calibrate_motion")
        self.assertTrue(answer.success, answer.message)
        self.expect_the_truth(answer.report)
        wait_for(lambda: self.client.revision() == 1, "the parameters")
        found = values_of(self.client.latest("parameters"))
        self.expect_wishes()
        self.assertTrue(self.client.call("forget_motion").success)
        self.assertIn("No motion is recorded", self.client.call("calibrate_motion").message)
        self.node.kill()
        self.client.start(self.node)
        self.assertEqual(values_of(self.client.latest("parameters")), found)
        self.assertEqual(self.client.latest("status").grade, answer.report.grade)
        # A motion that was forgotten is not taken up; what it told is.
        self.assertIn("No motion is recorded", self.client.call("calibrate_motion").message)
        self.assertEqual(self.client.revision(), 1)


if __name__ == "__main__":
    rospy.init_node("calibration_motion")
    rostest.rosrun(PACKAGE, "calibration_motion", LiveMotion, sys.argv)
