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
        # A message that the player loses changes the last digits of a mean.
        for samples in self.by_pose().values():
            for sample in samples[1:]:
                self.assertLess(abs((sample.header.stamp - samples[0].header.stamp).to_sec()), 0.1)
                for part in ("x", "y", "z", "w"):
                    difference = getattr(sample.orientation, part) - getattr(samples[0].orientation, part)
                    self.assertLess(abs(difference), 1e-3)
        answer = self.client.call("calibrate_joint")
        self.assertTrue(answer.success, answer.message)
        self.report_tells_the_grade_of_what_is_in_force_now()

    def report_tells_the_grade_of_what_is_in_force_now(self):
        wait_for(lambda: self.grades() == {"not_validated"}, "report and status of the cycle")
        # Each topic has a connection of its own: the parameters may come after the report of them.
        identified = self.client.latest("status").revision
        wait_for(lambda: self.client.revision() == identified, "parameters of the cycle")
        self.assertTrue(self.client.call("reset").success)
        wait_for(lambda: self.grades() == {"failed"}, "report and status of nominal parameters")
        self.assertTrue(self.client.call("restore", revision=identified).success)
        wait_for(lambda: self.grades() == {"not_validated"}, "report and status, restored")

    def grades(self):
        latest = (self.client.latest("report"), self.client.latest("status"))
        return {message.grade for message in latest if message}

    def all_rounds_are_held(self):
        poses = self.by_pose().values()
        return len(poses) == POSES and min(map(len, poses)) >= ROUNDS

    def by_pose(self):
        """Samples held at each pose, in the order of their capture."""
        poses = {}
        for sample in self.client.held().values():
            place = next((p for p in poses if all(abs(a - b) < 0.02 for a, b in zip(p, sample.joint_position))), None)
            poses.setdefault(place or tuple(sample.joint_position), []).append(sample)
        return poses


if __name__ == "__main__":
    rospy.init_node("calibration_bag_loop")
    rostest.rosrun(PACKAGE, "calibration_bag_loop", BagLoop, sys.argv)
