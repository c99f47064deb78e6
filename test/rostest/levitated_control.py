#!/usr/bin/python3
"""A rotor without joints in the hands of its coils: the controller follows the tracker, and the live view shows it."""

import math
import sys

import rospy
import rostest
import yaml
from calibration_client import NAMESPACE, PACKAGE, wait_for
from controller_client import LIMIT, Commands, Controller, parameters_of, target
from driver_node import ERROR, OK
from emulated_lab import LabCase
from geometry_msgs.msg import QuaternionStamped
from launch_client import Launch, launch_file
from spherical_actuator_calibration.msg import ActuatorParameters
from tf2_msgs.msg import TFMessage

MOST_ATTEMPTS = 6
FRICTION = 0.01  # [N.m.s] that a rotor falls slowly while the computer is busy with something else
LARGEST_AGE = 1.0  # [s] of orientations, likewise
LOAD = [0.003, -0.004, 0.002]  # [N.m] of the shipped emulator


class LevitatedControl(LabCase):
    @classmethod
    def setUpClass(cls):
        cls.make_lab(released=True, commands=False, seed=4, unit="reaction_sphere")
        cls.lab.change_emulator(friction={"viscous": FRICTION})
        cls.true_orientation = None
        rospy.Subscriber(f"{NAMESPACE}/lab_emulator/true_orientation", QuaternionStamped, cls.keep)
        cls.commands = Commands()
        cls.lab.start()
        wait_for(lambda: cls.true_orientation, "the true orientation")
        with open(cls.lab.truth, encoding="utf-8") as file:
            cls.truth = yaml.safe_load(file)["actuator"]
        cls.controller = Controller(
            actuator=cls.lab.actuator, rotor={"unbalance": LOAD}, largest_age=LARGEST_AGE
        )
        cls.addClassCleanup(cls.controller.close)
        cls.parameters = rospy.Publisher(f"{NAMESPACE}/parameters", ActuatorParameters, queue_size=1, latch=True)

    def setUp(self):
        self.lab.fault("release_fixture", False)
        self.lab.move((0.0, 0.0, 0.0))

    @classmethod
    def keep(cls, message):
        cls.true_orientation = message.quaternion

    def distance(self, message):
        """Angle [rad] of the true orientation to a target."""
        return angle_between(self.true_orientation, message.quaternion)

    def has_stopped(self):
        return self.controller.level("control") == ERROR

    def turns_to(self, goal):
        """Lets the rotor go; whether it came to the goal, and is held there."""
        self.parameters.publish(parameters_of(self.truth))
        # Again where it stops before it is seen to be active: on a busy computer orientations are late.
        wait_for(lambda: self.controller.enable().success and not self.has_stopped(), "the control")
        self.lab.fault("release_fixture", True)
        self.controller.send(goal)
        wait_for(lambda: self.has_stopped() or self.distance(goal) < 5e-3, "the target")
        return self.controller.level("control") == OK

    def stops_without_tracker(self):
        self.lab.fault("lose_tracker", True)
        self.controller.wait_for_level("control", ERROR)
        wait_for(self.commands.ended_with_zero, "zero")
        self.lab.fault("lose_tracker", False)
        return "orientations" in self.controller.message("control")

    def test_turns_the_free_rotor_and_stops_without_its_tracker(self):
        goal = target(0.1, 0.05, 0.2)
        for attempt in range(MOST_ATTEMPTS):
            if attempt > 0:
                self.setUp()
            if self.turns_to(goal) and self.stops_without_tracker():
                break
        else:
            self.fail(f"{MOST_ATTEMPTS} attempts failed")
        self.assertLessEqual(self.commands.largest, LIMIT)
        self.lab.fault("release_fixture", False)
        self.lab.move((0.0, 0.0, 0.0))
        self.controller.wait_until_enabled()

    def test_the_live_view_turns_with_the_tracker(self):
        frames = {}

        def keep(message):
            for each in message.transforms:
                frames[each.child_frame_id] = each

        subscriber = rospy.Subscriber("/tf", TFMessage, keep)
        self.addCleanup(subscriber.unregister)
        view = Launch(launch_file("view.launch"), rviz=False)
        self.addCleanup(view.stop)
        turns = (0.2, 0.3, -2.0)
        self.lab.move(turns)
        wanted = self.lab.readings.target(turns).quaternion

        def is_shown(frame):
            shown = frames.get(frame)
            return shown and angle_between(shown.transform.rotation, wanted) < 5e-3

        for frame in ("rotor", "rotor_nominal"):
            wait_for(lambda: is_shown(frame), f"the frame {frame}")  # noqa: B023
            self.assertEqual(frames[frame].header.frame_id, "stator")
        self.assertNotIn("joint_1", frames)


def angle_between(a, b):
    return 2.0 * math.acos(min(1.0, abs(a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w)))


if __name__ == "__main__":
    rospy.init_node("levitated_control_test")
    rostest.rosrun(PACKAGE, "levitated_control", LevitatedControl, sys.argv)
