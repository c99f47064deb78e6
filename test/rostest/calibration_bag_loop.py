#!/usr/bin/python3
"""A recording that is played in a loop: time jumps back at each end, and every round gives its samples."""

import os
import sys
import tempfile
import unittest

import rospy
import rostest
from calibration_client import (
    PACKAGE,
    CalibrationClient,
    CalibrationNode,
    play,
    run_tool,
    stop_player,
    wait_for,
)

ROUNDS = 3
POSES = 5


class BagLoop(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.bag = os.path.join(self.folder.name, "session.bag")
        run_tool(
            "simulate_recording",
            actuator=os.path.join(rospy.get_param("~config"), "pm_spherical_8x24.yaml"),
            output=self.bag,
            **{"joint-poses": POSES, "main-coil-poses": 0, "coil-poses": 0, "validation-poses": 0},
        )
        self.client = CalibrationClient()
        directory = os.path.join(self.folder.name, "calibration")
        self.node = CalibrationNode(directory, auto_capture=True)
        self.addCleanup(self.node.stop)
        self.client.start(self.node)

    def test_every_round_gives_the_same_samples(self):
        player = play(self.bag, "--loop", "--clock", "--rate", "2")
        self.addCleanup(stop_player, player)
        wait_for(self.all_rounds_are_held, f"{ROUNDS} rounds of {POSES} samples")
        samples = list(self.client.held().values())
        # The last round may be under way.
        for first, later in zip(samples, samples[POSES : ROUNDS * POSES]):
            self.assertEqual(later.header.stamp, first.header.stamp)
            self.assertEqual(later.joint_position, first.joint_position)
            self.assertEqual(later.orientation, first.orientation)
        answer = self.client.call("calibrate_joint")
        self.assertTrue(answer.success, answer.message)
        self.report_tells_the_grade_of_what_is_in_force_now()

    def report_tells_the_grade_of_what_is_in_force_now(self):
        wait_for(lambda: self.grades() == {"not_validated"}, "report and status of the cycle")
        identified = self.client.revision()
        self.assertTrue(self.client.call("reset").success)
        wait_for(lambda: self.grades() == {"failed"}, "report and status of nominal parameters")
        self.assertTrue(self.client.call("restore", revision=identified).success)
        wait_for(lambda: self.grades() == {"not_validated"}, "report and status, restored")

    def grades(self):
        latest = (self.client.latest("report"), self.client.latest("status"))
        return {message.grade for message in latest if message}

    def all_rounds_are_held(self):
        return self.client.latest("status").orientation_samples >= ROUNDS * POSES


if __name__ == "__main__":
    rospy.init_node("calibration_bag_loop")
    rostest.rosrun(PACKAGE, "calibration_bag_loop", BagLoop, sys.argv)
