#!/usr/bin/python3
"""The panel of rviz beside a rotor without joints: a whole calibration by it alone, in which level 1 has no place."""

import sys

import rospy
import rostest
from calibration_client import PACKAGE
from panel_hand import PanelHandCase
from spherical_actuator_calibration.msg import CalibrationReport

JOINT = "F6"
POSES = 8  # that the panel plans by itself
HELD_OUT = 2


class LevitatedPanel(PanelHandCase):
    @classmethod
    def setUpClass(cls):
        cls.start_panel(unit="reaction_sphere")

    def test_a_whole_calibration(self):
        self.key(JOINT)
        self.calibrate(POSES, HELD_OUT)
        self.assertIsNone(self.report(CalibrationReport.JOINT), "the key of level 1 does nothing")
        self.assertFalse([sample.id for sample in self.samples if not sample.has_orientation])


if __name__ == "__main__":
    rospy.init_node("levitated_panel_test")
    rostest.rosrun(PACKAGE, "levitated_panel", LevitatedPanel, sys.argv)
