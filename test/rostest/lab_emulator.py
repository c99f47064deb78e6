#!/usr/bin/python3
"""The emulated laboratory through the drivers, the bridge and the calibration node."""

import math
import sys

import numpy as np
import rospy
import rostest
import yaml
from calibration_client import NAMESPACE, PACKAGE, wait_for
from emulated_lab import LabCase
from geometry_msgs.msg import QuaternionStamped

POSE = [0.2, -0.15, 0.8]
UNBALANCE = 5.4e-3  # [N.m] of the shipped configuration
SETTLED = 0.3  # [s] of a capture
PATIENCE = 10.0  # [s] before another outlier


def rotation(axis, angle):
    x, y, z = np.asarray(axis) / np.linalg.norm(axis)
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross


def quaternion_matrix(q):
    """Rotation of a geometry_msgs/Quaternion."""
    vector = np.array([q.x, q.y, q.z])
    length = np.linalg.norm(vector)
    return rotation(vector, 2.0 * math.atan2(length, q.w)) if length > 0.0 else np.eye(3)


def true_orientation(truth, q):
    """Product of exponentials of a description at the joint angles."""
    result = np.eye(3)
    for joint, angle in zip(truth["joints"], q):
        result = result @ rotation(joint["axis"], angle + joint["offset"])
    return result


def angle_between(one, other):
    return math.acos(min(1.0, 0.5 * (np.trace(one.T @ other) - 1.0)))


class LabEmulator(LabCase):
    @classmethod
    def setUpClass(cls):
        cls.make_lab(released=True, seed=3)
        cls.start_lab()

    def setUp(self):
        self.lab.excite(0, 0.0)

    def capture(self):
        """A sample of the present dwell, as soon as the node gives one."""

        def taken():
            answer = self.client.call("capture", duration=SETTLED, validation=False)
            self.refusal = answer.message
            return answer.success and answer.sample

        return wait_for(taken, "a sample")

    def refused_until(self, part):
        """Captures until the refusal names what is wrong."""

        def refused():
            answer = self.client.call("capture", duration=SETTLED, validation=False)
            return not answer.success and part in answer.message

        wait_for(refused, f"a refusal that names {part}")

    def test_measures_the_unit_that_it_has_made(self):
        with open(self.lab.truth, encoding="utf-8") as file:
            truth = yaml.safe_load(file)["actuator"]
        self.assertNotEqual(truth["joints"][0]["offset"], 0.0)
        self.lab.move(POSE)
        sample = self.capture()
        measured = quaternion_matrix(sample.orientation)
        expected = true_orientation(truth, sample.joint_position)
        self.assertLess(angle_between(measured, expected), 8.0 * sample.orientation_stddev)
        nominal = [{"axis": axis, "offset": 0.0} for axis in np.eye(3)]
        self.assertGreater(angle_between(measured, true_orientation({"joints": nominal}, POSE)), 5e-3)

    def test_a_coil_turns_the_rotor(self):
        self.lab.move(POSE)
        self.capture()
        self.lab.excite(1, 2.0)
        sample = wait_for(
            lambda: (lambda s: s.current[0] > 1.9 and s)(self.capture()), "a sample with current"
        )
        self.assertTrue(sample.has_torque)
        torque = np.array([sample.torque.x, sample.torque.y, sample.torque.z])
        self.assertGreater(np.linalg.norm(torque), 10.0 * UNBALANCE)

    def test_targets_that_cannot_be_are_refused(self):
        self.lab.move(POSE)
        self.lab.targets.publish(name=["joint_1", "joint_2", "joint_3"], position=[2.0, 0.0, 0.0])
        self.lab.targets.publish(name=["joint_1"], position=[0.0])
        self.lab.targets.publish(
            name=["joint_1", "joint_2", "joint_3"], position=[math.nan, 0.0, 0.0]
        )
        # What comes after them is followed.
        self.lab.move([0.1, 0.0, 0.8])
        self.lab.move(POSE)

    def test_a_lost_tracker_is_told_and_cured(self):
        self.lab.move(POSE)
        self.lab.fault("lose_tracker", True)
        self.refused_until("measured_orientation")
        self.lab.fault("lose_tracker", False)
        self.capture()

    def test_a_tripped_amplifier_gives_no_current(self):
        self.lab.move(POSE)
        self.lab.excite(1, 2.0)
        self.lab.fault("trip_amplifier", True)
        wait_for(lambda: abs(self.capture().current[0]) < 0.01, "no current")
        self.lab.fault("trip_amplifier", False)
        wait_for(lambda: self.capture().current[0] > 1.9, "current again")

    def test_a_frozen_sensor_does_not_see_the_move(self):
        self.lab.move(POSE)
        self.lab.fault("freeze_sensor", True)
        before = self.lab.readings.fresh()
        before_orientation = self.orientation()
        self.lab.targets.publish(name=["joint_1", "joint_2", "joint_3"], position=[0.0, 0.0, 0.0])
        wait_for(lambda: self.turned_from(before_orientation) > 0.5, "the rotor to turn")
        self.assertTrue(self.lab.is_at(before))
        self.lab.fault("freeze_sensor", False)
        wait_for(lambda: self.lab.is_at([0.0, 0.0, 0.0]), "the sensor to follow")

    def test_an_outlier_is_one_measurement_far_off(self):
        self.lab.move(POSE)
        self.capture()
        wait_for(self.outlier_is_refused, "the bridge to refuse an outlier")

    def outlier_is_refused(self):
        """One at a time; after a pause of the tracker, as on a busy computer, the bridge takes it for a turn."""
        refused = self.refusals()
        self.lab.inject_outlier()
        try:
            return wait_for(lambda: self.refusals() > refused, "a refusal", PATIENCE)
        except AssertionError:
            return False

    def orientation(self):
        message = rospy.wait_for_message(f"{NAMESPACE}/measured_orientation", QuaternionStamped)
        return quaternion_matrix(message.quaternion)

    def turned_from(self, orientation):
        return angle_between(orientation, self.orientation())

    def refusals(self):
        status = self.client._diagnostics.get("actuator/tracker_bridge: tracker/pose")
        values = {value.key: value.value for value in status.values} if status else {}
        return int(values.get("refused", 0))


if __name__ == "__main__":
    rospy.init_node("lab_emulator_test")
    rostest.rosrun(PACKAGE, "lab_emulator", LabEmulator, sys.argv)
