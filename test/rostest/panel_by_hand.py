#!/usr/bin/python3
"""A whole calibration by the panel of rviz alone. Saved and validated, it holds the truth."""

import sys

import rospy
import rostest
from calibration_client import PACKAGE
from panel_hand import PanelHandCase

POSES = 8  # that the panel plans by itself
HELD_OUT = 2


class PanelByHand(PanelHandCase):
    @classmethod
    def setUpClass(cls):
        cls.start_panel()

    def test_a_whole_calibration(self):
        self.calibrate(POSES, HELD_OUT)


if __name__ == "__main__":
    rospy.init_node("panel_by_hand_test")
    rostest.rosrun(PACKAGE, "panel_by_hand", PanelByHand, sys.argv)
