#!/usr/bin/python3
"""register_frames finds the frames of a recording, and the same live; without enough poses it says what is missing."""

import os
import re
import shlex
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import rosbag
import rospy
import rostest
import yaml
from calibration_client import DEADLINE, NAMESPACE, PACKAGE, program, run_tool, stop_player

SESSION = {
    "seed": 3,
    "joint-poses": 9,
    "main-coil-poses": 0,
    "coil-poses": 0,
    "validation-poses": 0,
    "tracker-rate": 100,
    "joint-rate": 100,
}
TOPICS = [f"{NAMESPACE}/joint_states", f"{NAMESPACE}/tracker/pose"]


def actuator_file():
    return os.path.join(rospy.get_param("~config"), "pm_spherical_8x24.yaml")


def turn_between(a, b):
    """Angle between two rotations, xyzw [rad]."""
    return 2.0 * np.arccos(min(1.0, abs(np.dot(a, b))))


class RegisterFrames(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.bag = os.path.join(cls.folder.name, "session.bag")
        run_tool("simulate_recording", actuator=actuator_file(), output=cls.bag, **SESSION)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def register(self, *arguments, ns=NAMESPACE):
        return subprocess.run(
            [program("register_frames"), "--actuator", actuator_file(), "--ns", ns, *arguments],
            capture_output=True,
            text=True,
            check=False,
            timeout=DEADLINE,
        )

    def load(self, name):
        with open(os.path.join(self.folder.name, name), encoding="utf-8") as file:
            return yaml.safe_load(file)

    def recorded_registration(self):
        with rosbag.Bag(self.bag) as bag:
            for _, message, _ in bag.read_messages(topics=["/tf_static"]):
                return {
                    transform.child_frame_id: [getattr(transform.transform.rotation, axis) for axis in "xyzw"]
                    for transform in message.transforms
                }
        return None

    def check(self, found):
        truth = self.recorded_registration()
        for name, frame in (("stator_tracker", "tracker"), ("rotor_marker", "marker")):
            one = found["registered_frames"][name]
            # Three of its worst standard deviations; the joints were made with errors.
            self.assertLess(turn_between(one["quaternion_xyzw"], truth[frame]), 3.0 * np.linalg.norm(one["stddev"]))
            self.assertLess(max(one["stddev"]), 0.06)

    def launches_as_printed(self, said):
        """The calibration node gets the covariance that is printed as an argument."""
        (line,) = re.findall(r"^ *(tracker_and_marker_covariance:=.*)$", said, re.MULTILINE)
        dumped = subprocess.run(
            ["roslaunch", "--dump-params", PACKAGE, "lab.launch", *shlex.split(line)],
            stdout=subprocess.PIPE,
            text=True,
            check=True,
        )
        (covariance,) = (
            value for key, value in yaml.safe_load(dumped.stdout).items() if key.endswith("tracker_and_marker/covariance")
        )
        self.assertEqual(covariance, self.load("offline.yaml")["registration"]["tracker_and_marker"]["covariance"])
        self.assertEqual([type(each) for each in covariance], 36 * [float])

    def test_a_recording_and_the_same_live(self):
        output = os.path.join(self.folder.name, "offline.yaml")
        answer = self.register("--output", output, self.bag)
        self.assertEqual(answer.returncode, 0, answer.stdout + answer.stderr)
        self.assertRegex(answer.stdout, r"stator_tracker:=\"0 0 0 [-0-9. e]+\"")
        offline = self.load("offline.yaml")
        self.check(offline)
        self.launches_as_printed(answer.stdout)

        live_output = os.path.join(self.folder.name, "live.yaml")
        live = subprocess.Popen(
            [
                program("register_frames"),
                *("--ns", NAMESPACE, "--output", live_output),
                *("--poses", "7", "--duration", "0.5"),
            ],
            stdout=subprocess.PIPE,
            text=True,
        )
        self.assertIn("Turn the rotor", live.stdout.readline())
        player = subprocess.Popen(
            ["rosbag", "play", self.bag, "--quiet", "--queue", "100000", "--keep-alive", "--wait-for-subscribers"]
            + ["--topics", *TOPICS],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
        )
        try:
            said, _ = live.communicate(timeout=DEADLINE)
        finally:
            stop_player(player)
            live.kill()
        self.assertEqual(live.returncode, 0, said)
        self.assertEqual(len(re.findall(r"^Pose \d+ of 7 is taken", said, re.MULTILINE)), 7, said)
        found = self.load("live.yaml")
        self.check(found)
        for name in ("stator_tracker", "rotor_marker"):
            offline_one, live_one = (text["registered_frames"][name] for text in (offline, found))
            self.assertLess(
                turn_between(offline_one["quaternion_xyzw"], live_one["quaternion_xyzw"]),
                3.0 * np.linalg.norm(offline_one["stddev"]),
            )

    def test_what_cannot_be_used_is_told(self):
        few = os.path.join(self.folder.name, "few.bag")
        run_tool("simulate_recording", actuator=actuator_file(), output=few, **{**SESSION, "joint-poses": 3})
        answer = self.register(few)
        self.assertEqual(answer.returncode, 1, answer.stdout)
        self.assertIn("There are 3 different poses; at least 6", answer.stdout)
        other = self.register(self.bag, ns="/elsewhere")
        self.assertEqual(other.returncode, 2)
        self.assertIn("no message of /elsewhere/joint_states", other.stderr)


if __name__ == "__main__":
    rospy.init_node("register_frames_test")
    rostest.rosrun(PACKAGE, "register_frames", RegisterFrames, sys.argv)
