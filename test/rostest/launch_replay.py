#!/usr/bin/python3
"""replay.launch plays a recording into the calibration node, with or without the bridge."""

import os
import sys
import tempfile
import unittest

import rospy
import rostest
from calibration_client import DEADLINE, NODE, PACKAGE, CalibrationClient, run_tool, wait_for
from launch_client import Launch, launch_file, missing_programs, nodes_of

POSES = 5
SESSION = {"joint-poses": POSES, "main-coil-poses": 0, "coil-poses": 0, "validation-poses": 0}


class LaunchReplay(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.bag = cls.path("session of today.bag")
        description = os.path.join(rospy.get_param("~config"), "pm_spherical_8x24.yaml")
        run_tool("simulate_recording", actuator=description, output=cls.bag, **SESSION)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder.name, name)

    def test_every_program_is_there(self):
        nodes = nodes_of(launch_file("replay.launch"), bag="session.bag", bridge=True)
        self.assertEqual(
            sorted(node.name for node in nodes), ["calibration", "play", "tracker_bridge"]
        )
        self.assertEqual(missing_programs(nodes), [])

    def samples_of(self, directory, **arguments):
        """Samples of the whole recording, in their order."""
        client = CalibrationClient()
        client.forget()  # what the launch before has published
        launch = Launch(
            launch_file("replay.launch"),
            bag=self.bag,
            directory=self.path(directory),
            rate=2,
            **arguments,
        )
        self.addCleanup(launch.stop)
        wait_for(lambda: client.latest("status"), "status")
        rospy.wait_for_service(f"{NODE}/save", DEADLINE)
        wait_for(
            lambda: client.latest("status").orientation_samples >= POSES, f"{POSES} samples"
        )
        samples = list(client.held().values())
        launch.stop()
        self.assertEqual(len(samples), POSES)
        return samples

    def test_the_bridge_gives_the_samples_that_were_measured(self):
        recorded = self.samples_of("recorded")
        derived = self.samples_of("derived", bridge=True)
        for one, other in zip(recorded, derived):
            self.assertEqual(one.header.stamp, other.header.stamp)
            self.assertEqual(one.measurements, other.measurements)
            self.assertEqual(one.joint_position, other.joint_position)
            for component in ("x", "y", "z", "w"):
                self.assertAlmostEqual(
                    getattr(one.orientation, component),
                    getattr(other.orientation, component),
                    delta=1e-9,
                )


if __name__ == "__main__":
    rospy.init_node("launch_replay_test")
    rostest.rosrun(PACKAGE, "launch_replay", LaunchReplay, sys.argv)
