#!/usr/bin/python3
"""The live view in rviz and its panel, on a screen that nobody sees: what it draws, that it follows, and that a
click on the panel does what the button says."""

import sys
import time

import rospy
import rostest
from calibration_client import NAMESPACE, PACKAGE, wait_for
from spherical_actuator_calibration.msg import CalibrationSample
from tf2_msgs.msg import TFMessage
from viewed_lab import ViewedLabCase, find_button
from visualization_msgs.msg import MarkerArray

FEWEST_COLOURS = 200
FEWEST_PIXELS = 30


def count(pixels, condition):
    return sum(1 for red, green, blue in pixels if condition(red, green, blue))


def is_red(red, green, blue):
    return red > 110 and green < 0.5 * red and blue < 0.5 * red


def is_blue(red, green, blue):
    return blue > 110 and red < 0.6 * blue and green < 0.8 * blue


def is_glowing(red, green, blue):
    return red > 140 and green > 0.75 * red and blue < 0.4 * red


class LiveView(ViewedLabCase):
    @classmethod
    def setUpClass(cls):
        cls.make_lab()
        cls.markers = []
        cls.frames = {}
        rospy.Subscriber(f"{NAMESPACE}/calibration_markers", MarkerArray, cls.markers.append)
        rospy.Subscriber("/tf", TFMessage, cls.keep_frames)
        cls.samples = []
        rospy.Subscriber(f"{NAMESPACE}/samples", CalibrationSample, cls.samples.append)
        cls.start_lab()

    @classmethod
    def keep_frames(cls, message):
        for transform in message.transforms:
            cls.frames[transform.child_frame_id] = transform

    def shows(self, condition):
        """Until enough pixels of the picture meet the condition."""
        wait_for(
            lambda: count(self.picture(), condition) >= FEWEST_PIXELS, "the colour in the picture"
        )

    def test_draws_poles_coils_and_the_excited_one(self):
        self.lab.move([0.2, -0.1, 0.3])
        self.shows(is_red)
        self.shows(is_blue)
        self.lab.excite(1, 2.0)
        self.shows(is_glowing)
        self.assertGreater(len(set(self.screen.pixels())), FEWEST_COLOURS)

    def test_frames_follow_the_joints(self):
        self.lab.move([0.0, 0.0, 0.0])
        self.lab.move([0.0, 0.0, 1.0])
        wait_for(lambda: {"rotor_nominal", "rotor"} <= self.frames.keys(), "frames of the rotor")
        wait_for(lambda: abs(self.frames["rotor_nominal"].transform.rotation.z) > 0.47, "the nominal rotor")
        self.assertEqual(self.frames["rotor_nominal"].header.frame_id, "stator")
        self.assertEqual(self.frames["rotor"].header.frame_id, "joint_2")

    def test_a_sample_is_a_dot(self):
        def captured():
            return self.client.call("capture", duration=0.3, validation=False).success

        wait_for(captured, "a sample")

        def is_drawn():
            newest = self.markers[-1].markers if self.markers else []
            groups = [marker for marker in newest if marker.ns == "samples"]
            return groups and groups[0].points

        wait_for(is_drawn, "the dot of the sample")

    def test_a_click_on_the_panels_capture_button_makes_a_sample(self):
        self.lab.move([0.1, 0.1, 0.5])
        self.wait_for_panel()
        before = len(self.samples)

        def captured():
            # Refused while the fixture still settles, of the pose before where the node is behind, and pale while it
            # waits for the answer: as an operator would, click again.
            place = find_button(self.picture())
            if place:
                self.screen.click(*place)
                time.sleep(1.0)
            return any(abs(sample.joint_position[2] - 0.5) < 0.1 for sample in self.samples[before:])

        wait_for(captured, "the sample of the click")


if __name__ == "__main__":
    rospy.init_node("live_view_test")
    rostest.rosrun(PACKAGE, "live_view", LiveView, sys.argv)
