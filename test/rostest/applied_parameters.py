#!/usr/bin/python3
"""What was identified is applied where a machine runs: the controller commands, and the live view shows, what a saved
description predicts, though both were started with the drawing."""

import copy
import os
import sys
import tempfile
import unittest

import numpy as np
import rospy
import rostest
import yaml
from calibration_client import NAMESPACE, PACKAGE, run_tool, wait_for
from controller_client import Controller, description
from driver_node import DriverNode
from sensor_msgs.msg import JointState
from spherical_actuator_calibration.coil_drive.parameters import parameters_in_force, wait_for_control_by
from spherical_actuator_calibration.msg import CoilCurrents
from tf2_msgs.msg import TFMessage

RATE = 200.0  # [Hz] of joint angles
PATIENT = 3600.0  # [s] of joint angles, whose age is not what is tested
SAME = 1e-9  # [rad], [N m]
READINGS = ([0.1, -0.05, 0.3], [-0.2, 0.25, -2.0], [0.05, 0.3, 1.4])  # [rad]
CHAIN = ("joint_1", "joint_2", "rotor")


def corrected(actuator):
    """The unit with all that a calibration may identify, larger than usual."""
    rng = np.random.default_rng(4)

    def drawn(size, *shape):
        return rng.uniform(-size, size, shape).tolist()

    unit = copy.deepcopy(actuator)
    for joint in unit["joints"]:
        axis = np.array(joint["axis"]) + rng.uniform(-0.02, 0.02, 3)
        joint.update(axis=(axis / np.linalg.norm(axis)).tolist(), offset=rng.uniform(-0.02, 0.02))
        joint.update(linear=drawn(0.02, 3), harmonics=drawn(0.02, 4))
    for axis in unit["poles"] + unit["coils"]:
        axis["polar"] += rng.uniform(-0.02, 0.02)
        axis["azimuth"] += rng.uniform(-0.02, 0.02)
        axis["gain"] = rng.uniform(0.9, 1.1)
    # Currents hold the weight: they are those of the torque law.
    unit["rotor_unbalance"] = [0.003, -0.004, 0.002]
    unit["orientation_map"] = {
        "length": [0.5, 0.6, 0.7],
        "amplitude": [0.01, 0.02, 0.03],
        "noise": [1e-4, 2e-4, 3e-4],
        "points": [
            {"reading": (np.array(reading) + rng.uniform(-0.2, 0.2, 3)).tolist(), "rotation": drawn(0.02, 3)}
            for reading in READINGS
        ],
    }
    return unit


def with_polynomial(unit):
    coefficients = unit["torque_curve"]["coefficients"]
    unit["torque_curve"]["coefficients"] = [1.05 * coefficients[0], 0.97 * coefficients[1], *coefficients[2:]]


def with_table(unit):
    """A change of it, as a calibration identifies one, beside the points."""
    unit["torque_curve"] = {
        "angle_unit": "deg",
        "table": {
            "angles": [0.0, 2.0, 6.0, 10.0, 14.0, 18.0, 22.0, 26.0, 29.0, 32.0],
            "torques": [0.0, 0.1, 0.23, 0.28, 0.26, 0.2, 0.13, 0.06, 0.02, 0.0],
        },
        "coefficients": [1e-3, -2e-3, 1e-4],
        "blend_start": 2.0,
        "support": [28.0, 32.0],
    }


def rotation(x, y, z, w):
    v = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + 2.0 * w * v + 2.0 * v @ v


class Predictions:
    """Of a description, read again."""

    def __init__(self, folder, actuator):
        self._folder = folder
        self.path = os.path.join(folder, "calibrated.yaml")
        with open(self.path, "w", encoding="utf-8") as file:
            yaml.safe_dump({"actuator": actuator}, file)

    def at(self, reading, currents):
        """Rotation, and torque of coils and weight together."""
        joints, amperes, output = (os.path.join(self._folder, name) for name in ("q.csv", "i.csv", "r.csv"))
        np.savetxt(joints, [reading], delimiter=",", fmt="%.17g")
        np.savetxt(amperes, [currents], delimiter=",", fmt="%.17g")
        options = {"actuator": self.path, "joints": joints, "currents": amperes, "output": output}
        run_tool("predict", ["--unbalance", "--force"], **options)
        row = np.loadtxt(output, delimiter=",")
        return rotation(*row[:4]), row[5:8]


class AppliedParameters(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.frames, self.currents, self.commands = {}, None, 0
        self.position, self.readings = READINGS[0], 0
        self.publisher = rospy.Publisher(f"{NAMESPACE}/joint_states", JointState, queue_size=10)
        timer = rospy.Timer(rospy.Duration(1.0 / RATE), self.publish)
        self.addCleanup(timer.shutdown)
        for topic, kind, keep in (
            (f"{NAMESPACE}/coil_command", CoilCurrents, self.keep_command),
            ("/tf", TFMessage, self.keep_frames),
        ):
            self.addCleanup(rospy.Subscriber(topic, kind, keep).unregister)

    def publish(self, _event):
        message = JointState(name=["joint_1", "joint_2", "joint_3"], position=self.position)
        message.header.stamp = rospy.Time.now()
        self.publisher.publish(message)
        self.readings += 1

    def keep_command(self, message):
        self.currents = message.current
        self.commands += 1

    def keep_frames(self, message):
        for transform in message.transforms:
            self.frames[transform.child_frame_id] = transform.transform.rotation

    def rest_at(self, reading):
        """Until velocities have settled at zero, and the picture is of this pose."""
        self.position = reading
        enough = self.readings + 200
        wait_for(lambda: self.readings > enough, "further joint angles")
        self.frames.clear()
        wait_for(lambda: set(CHAIN) <= self.frames.keys(), "the frames of the rotor")

    def held_currents(self, controller):
        """Of a controller that holds the rotor where it rests: it has nothing to do but to carry the weight."""
        controller.wait_until_enabled()
        enough = self.commands + 20
        wait_for(lambda: self.commands > enough, "commands")
        currents = self.currents
        controller.enable(False)
        return currents

    def shown(self):
        R = np.eye(3)
        for name in CHAIN:
            q = self.frames[name]
            R = R @ rotation(q.x, q.y, q.z, q.w)
        return R

    def expect_applied(self, unit):
        saved = Predictions(self.folder, unit)
        drawing = Predictions(tempfile.mkdtemp(dir=self.folder), description())
        with parameters_in_force(NAMESPACE, saved.path) as parameters:
            nodes = [Controller(largest_age=PATIENT, disturbance={"bandwidth": 0.0}), DriverNode("visualization", {})]
            try:
                wait_for_control_by(NAMESPACE, parameters)
                for reading in READINGS:
                    self.rest_at(reading)
                    currents = self.held_currents(nodes[0])
                    R, torque = saved.at(reading, currents)
                    self.assertLess(np.linalg.norm(torque), SAME)
                    self.assertLess(np.linalg.norm(self.shown() - R), SAME)
                    R_drawn, torque_drawn = drawing.at(reading, currents)
                    self.assertGreater(np.linalg.norm(R_drawn - R), 0.01)
                    self.assertGreater(np.linalg.norm(torque_drawn), 1e-3)
            finally:
                for node in nodes:
                    node.close()

    def test_with_a_polynomial(self):
        unit = corrected(description())
        with_polynomial(unit)
        self.expect_applied(unit)

    def test_with_a_table(self):
        unit = corrected(description())
        with_table(unit)
        self.expect_applied(unit)


if __name__ == "__main__":
    rospy.init_node("applied_parameters_test")
    rostest.rosrun(PACKAGE, "applied_parameters", AppliedParameters, sys.argv)
