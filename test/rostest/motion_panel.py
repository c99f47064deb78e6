#!/usr/bin/python3
"""What the panel of rviz shows of a motion while it goes on, and its button that calibrates by it, on a screen that nobody
sees; the streams are of a free rotor that the package did not simulate."""

import os
import pathlib
import sys
import tempfile

import rospy
import rostest
from calibration_client import (
    NAMESPACE,
    PACKAGE,
    CalibrationClient,
    CalibrationNode,
    play,
    stop_player,
    wait_for,
)
from launch_client import Launch, launch_file
from viewed_lab import ViewedCase

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
TAB, CALIBRATE = "alt+m", "alt+b"
PATIENCE = 20.0  # [s] in which a cycle ends; pressed again, it would run once more
MARGIN = (4, 400)  # left of all that takes the wheel itself; the scroll bar is elsewhere with Qt 6
FEWEST_PIXELS = 60  # of a line beside its mark in the legend


def is_purple(red, green, blue):
    """The line of the poles."""
    return abs(red - 142) < 20 and abs(green - 36) < 20 and abs(blue - 170) < 20


def is_orange(red, green, blue):
    """That of the coils."""
    return abs(red - 239) < 12 and abs(green - 108) < 12 and blue < 12


class MotionPanel(ViewedCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.bag = os.path.join(folder.name, "motion.bag")
        cls.record()
        cls.told = []
        rospy.Subscriber(f"{NAMESPACE}/motion_progress", MotionProgress, cls.told.append)
        cls.client = CalibrationClient()
        cls.node = CalibrationNode(os.path.join(folder.name, "calibration"))
        cls.addClassCleanup(cls.node.stop)
        cls.client.start(cls.node)
        view = Launch(launch_file("view.launch"), environment=cls.make_screen(), view=cls.view)
        cls.addClassCleanup(view.stop)
        cls.wait_for_panel()

    @classmethod
    def record(cls):
        unit = laboratory.paper_unit()
        errors = np.random.default_rng(SEED).uniform(-0.03, 0.03, unit.size())
        motion = free_motion.simulate(unit, errors, free_motion.Machine(), SECONDS, SEED)
        streams = free_motion.Streams(joint_rate=RATE, current_rate=RATE)
        write_bag(cls.bag, free_motion.record(unit, errors, motion, streams, SEED), len(unit.coils))

    def draws(self, colour):
        return sum(1 for pixel in self.screen.pixels() if colour(*pixel)) > FEWEST_PIXELS

    def draws_curves(self):
        """At the end of the panel, which is longer than the screen."""
        self.screen.scroll_down(*MARGIN)
        return self.draws(is_purple) and self.draws(is_orange)

    def has_calibrated(self):
        report = self.client.latest("report")
        return report is not None and report.cycle == "motion"

    def test_draws_what_is_known_and_calibrates(self):
        self.assertFalse(self.draws(is_purple))
        player = play(self.bag)
        self.addCleanup(stop_player, player)
        wait_for(lambda: self.told and self.told[-1].duration > 0.8 * SECONDS, "the last windows")
        self.press(TAB, self.draws_curves, "the lines of poles and coils")
        self.press(CALIBRATE, self.has_calibrated, "the report of the motion", pause=PATIENCE)
        self.assertTrue(self.client.latest("report").success, self.client.latest("report").message)
        wait_for(lambda: self.client.revision() == 1, "the parameters")


if __name__ == "__main__":
    rospy.init_node("motion_panel_test")
    rostest.rosrun(PACKAGE, "motion_panel", MotionPanel, sys.argv)
