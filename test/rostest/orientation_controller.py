#!/usr/bin/python3
"""The orientation controller without a laboratory: when it commands currents, and when it stops."""

import math
import signal
import sys
import unittest

import rospy
import rostest
from calibration_client import NAMESPACE, PACKAGE, wait_for
from controller_client import LIMIT, Commands, Controller, description, parameters_of, target
from driver_node import ERROR, OK
from sensor_msgs.msg import JointState
from spherical_actuator_calibration.msg import ActuatorParameters

RATE = 200.0  # [Hz] of joint angles
LARGEST_AGE = 1.0  # [s] of joint angles
PATIENT = 3600.0  # [s] of joint angles, where their age is not what is tested: on a busy computer they come late


class Joints:
    """A joint sensor that says what the test wants."""

    def __init__(self):
        self.position = [0.0, 0.0, 0.0]
        self.silent = False
        self.stamp = None  # of all further readings, where it stands still
        self.count = 0
        self._publisher = rospy.Publisher(f"{NAMESPACE}/joint_states", JointState, queue_size=10)
        self._timer = rospy.Timer(rospy.Duration(1.0 / RATE), self._publish)

    def _publish(self, _event):
        if not self.silent:
            message = JointState(name=["joint_1", "joint_2", "joint_3"], position=self.position)
            message.header.stamp = self.stamp or rospy.Time.now()
            self._publisher.publish(message)
            self.count += 1

    def wait_for_further(self, count):
        enough = self.count + count
        wait_for(lambda: self.count > enough, f"{count} further joint angles")

    def stop(self):
        self._timer.shutdown()
        self._publisher.unregister()


class OrientationController(unittest.TestCase):
    """The rotor stands where the test says."""

    def setUp(self):
        self.publisher = rospy.Publisher(f"{NAMESPACE}/parameters", ActuatorParameters, queue_size=1, latch=True)
        self.publisher.publish(parameters_of(description()))
        self.joints = Joints()
        self.commands = Commands()
        self.controller = None

    def tearDown(self):
        if self.controller:
            self.controller.close()
        self.commands.close()
        self.joints.stop()
        self.publisher.unregister()

    def start(self, **parameters):
        self.controller = Controller(**{"largest_age": PATIENT, **parameters})
        return self.controller

    def test_nothing_is_commanded_before_it_is_enabled(self):
        controller = self.start()
        controller.wait_for_level("control", OK)
        controller.send(target(0.1, 0.0, 0.0))
        # Targets are taken in their order: once this one is refused, the other one is in force.
        controller.send(target(0.1, 0.0, 0.0, "rotor"))
        wait_for(lambda: "rotor" in controller.value("control", "last refusal"), "the refusal")
        self.joints.wait_for_further(50)
        self.assertEqual(self.commands.count, 0)

    def test_follows_a_target_once_enabled_and_ends_with_zero(self):
        controller = self.start()
        controller.wait_until_enabled()
        controller.send(target(0.05, 0.0, 0.0))
        # The rotor does not move: the wanted torque stays.
        wait_for(lambda: self.commands.last > 0.005, "currents")
        self.assertLessEqual(self.commands.largest, LIMIT)
        self.assertTrue(controller.enable(False).success)
        wait_for(self.commands.ended_with_zero, "zero")

    def test_turns_to_joint_angles_by_all_that_was_identified(self):
        parameters = parameters_of(description())
        for joint in parameters.joints:
            joint.harmonics = [0.02, 0.0, 0.0, 0.01]
        self.publisher.publish(parameters)
        self.joints.position = [0.1, 0.05, 0.3]
        controller = self.start()
        controller.wait_until_enabled()

        def error():
            return float(controller.value("control", "tracking error [mrad]"))

        controller.send_joints(joint_1=0.1, joint_2=0.05, joint_3=0.35)
        wait_for(lambda: error() > 40.0, "a target elsewhere")
        # By axes and offsets alone it would be 40 mrad aside.
        controller.send_joints(joint_3=0.3, joint_2=0.05, joint_1=0.1)
        wait_for(lambda: error() < 0.1, "the target where the rotor is")
        controller.send_joints(joint_1=0.1, joint_2=0.05)
        wait_for(lambda: "joint_target" in controller.value("control", "last refusal"), "the refusal")

    def test_refuses_to_start_without_fresh_joint_angles(self):
        controller = self.start(largest_age=LARGEST_AGE)
        controller.wait_until_enabled()
        controller.enable(False)
        self.joints.silent = True

        def refused():
            answer = controller.enable()
            if answer.success:
                controller.enable(False)
            return not answer.success and "s old" in answer.message

        wait_for(refused, "the refusal of joint angles that are old")

    def test_stops_when_joint_angles_cease(self):
        controller = self.start(largest_age=LARGEST_AGE)
        wait_for(lambda: self.pulls(controller), "currents")
        self.joints.silent = True
        wait_for(self.commands.ended_with_zero, "zero")
        controller.wait_for_level("control", ERROR)
        self.assertIn("joint angles", controller.message("control"))
        self.joints.silent = False
        self.joints.wait_for_further(50)
        self.assertTrue(self.commands.ended_with_zero())
        wait_for(lambda: controller.enable().success and controller.level("control") == OK, "the control to go on")

    def test_each_reading_makes_one_command_and_no_reading_none(self):
        controller = self.start()
        controller.wait_until_enabled()
        wait_for(lambda: self.commands.count > 0, "commands")
        readings, commands = self.joints.count, self.commands.count
        self.joints.wait_for_further(200)
        # One may be on its way at either end; a busy computer leaves readings out.
        self.assertLessEqual(self.commands.count - commands, self.joints.count - readings + 2)
        self.assertGreater(self.commands.count - commands, 20)
        self.joints.silent = True
        wait_for(self.is_silent, "no further command")
        self.assertEqual(controller.level("control"), OK)
        self.joints.silent = False
        commands = self.commands.count
        wait_for(lambda: self.commands.count > commands, "commands on further readings")

    def is_silent(self):
        count = self.commands.count
        rospy.sleep(0.1)
        return self.commands.count == count

    def test_tells_the_age_of_readings_and_the_jitter_of_the_period(self):
        controller = self.start()
        controller.wait_until_enabled()
        self.joints.wait_for_further(50)
        wait_for(lambda: float(controller.value("control", "mean age of the reading [us]")) > 0.0, "the age")
        wait_for(lambda: float(controller.value("control", "jitter of the period [us]")) > 0.0, "the jitter")
        wait_for(lambda: float(controller.value("control", "rate [Hz]")) < 2.0 * RATE, "the rate")
        self.assertGreaterEqual(int(controller.value("control", "commands since start")), 20)
        self.assertGreaterEqual(int(controller.value("control", "of them on an old reading")), 0)

    def test_stops_when_the_stamps_of_joint_angles_stand_still(self):
        controller = self.start(largest_age=LARGEST_AGE)
        wait_for(lambda: self.pulls(controller), "currents")
        self.joints.stamp = rospy.Time.now()
        controller.wait_for_level("control", ERROR)
        self.assertIn("no joint angles arrive", controller.message("control"))
        wait_for(self.commands.ended_with_zero, "zero")

    def pulls(self, controller):
        """Whether there is current, so that a zero is that of a stop; where angles came late, it is enabled again."""
        if not controller.enable().success:
            return False
        controller.send(target(0.05, 0.0, 0.0))
        return self.commands.last > 0.005

    def test_stops_outside_the_workspace(self):
        controller = self.start()
        controller.wait_until_enabled()
        self.joints.position = [0.0, 0.7, 0.0]
        wait_for(self.commands.ended_with_zero, "zero")
        controller.wait_for_level("control", ERROR)
        self.assertIn("outside of the workspace", controller.message("control"))

    def test_is_not_enabled_where_the_coils_make_no_torque(self):
        controller = self.start(least_singular_value=10.0)
        wait_for(lambda: "no torque in some direction" in controller.enable().message, "the reason")
        self.assertEqual(self.commands.largest, 0.0)

    def test_refuses_targets_and_says_why(self):
        controller = self.start()
        controller.wait_until_enabled()
        not_unit = target(0.1, 0.0, 0.0)
        not_unit.quaternion.w = 2.0
        not_a_number = target(0.1, 0.0, 0.0)
        not_a_number.quaternion.x = math.nan
        for message, reason in (
            (target(0.1, 0.0, 0.0, "rotor"), 'in the frame "rotor"'),
            (not_unit, "unit length"),
            (not_a_number, "unit length"),
            (target(0.4, 0.0, 0.0), "outside of the workspace"),
        ):
            controller.send(message)
            wait_for(lambda r=reason: r in controller.value("control", "last refusal"), reason)
        self.assertLess(self.commands.largest, 0.01)

    def test_zero_when_it_is_ended(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            controller = self.start()
            controller.wait_until_enabled()
            controller.send(target(0.1, 0.0, 0.0))
            wait_for(lambda: self.commands.last > 0.0, "currents")
            controller.end(number)
            wait_for(self.commands.ended_with_zero, f"zero after signal {number}")

    def test_names_a_wrong_parameter(self):
        controller = self.start(gains={"proportional": -1.0})
        self.assertIn("gains.proportional", controller.wait_for_end())


if __name__ == "__main__":
    rospy.init_node("orientation_controller_test")
    rostest.rosrun(PACKAGE, "orientation_controller", OrientationController, sys.argv)
