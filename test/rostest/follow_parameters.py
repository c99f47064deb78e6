#!/usr/bin/python3
"""examples/follow_parameters: tells the torque of the strongest coil by the parameters in force."""

import math
import os
import pathlib
import re
import subprocess
import sys
import threading
import unittest

import numpy as np
import rospy
import rostest
import yaml
from calibration_client import NAMESPACE, PACKAGE, wait_for
from spherical_actuator_calibration.msg import ActuatorParameters, CoilAxis, PoleAxis

CONFIG = pathlib.Path(__file__).resolve().parents[2] / "config"
DESCRIPTION = CONFIG / "pm_spherical_8x24.yaml"
POSITIONER = CONFIG / "examples" / "two_axis_positioner" / "actuator.yaml"
NO_TORQUE = re.compile(r"revision (\d+) (\(\w+\)): an actuator without poles and coils exerts no torque")
LINE = re.compile(r"revision (\d+) \((\w+)\): coil (\d+) exerts ([\d.]+) N\*m/A")


def axis(angles):
    polar, azimuth = angles["polar"], angles["azimuth"]
    return np.array(
        [math.cos(polar) * math.cos(azimuth), math.cos(polar) * math.sin(azimuth), math.sin(polar)]
    )


def torque_at_home(actuator, coil):
    """Norm of the torque of one ampere [N·m]; no pole is within blend or fading of the curve there."""
    curve = actuator["torque_curve"]
    total = np.zeros(3)
    for pole in actuator["poles"]:
        direction = np.cross(axis(pole), axis(coil))
        angle = math.degrees(math.atan2(np.linalg.norm(direction), axis(pole) @ axis(coil)))
        if angle < curve["support"][0]:
            strength = np.polynomial.polynomial.polyval(angle, curve["coefficients"])
            total += pole["polarity"] * strength * direction / np.linalg.norm(direction)
    return np.linalg.norm(total)


def parameters(actuator, revision, gains=()):
    """Nominal geometry as a message, with gains of some coils, counted from 0."""
    message = ActuatorParameters(actuator=actuator["name"], revision=revision, source="nominal", has_joints=True)
    for joint, described in zip(message.joints, actuator["joints"]):
        joint.axis.x, joint.axis.y, joint.axis.z = described["axis"]
        joint.offset = described["offset"]
    message.poles = [PoleAxis(gain=1.0, **pole) for pole in actuator.get("poles", ())]
    message.coils = [CoilAxis(gain=1.0, **coil) for coil in actuator.get("coils", ())]
    for coil, gain in dict(gains).items():
        message.coils[coil].gain = gain
    return message


class FollowParameters(unittest.TestCase):
    def follow(self, description):
        """Starts the node with a description, whose nominal parameters are in force."""
        self.actuator = yaml.safe_load(description.read_text())["actuator"]
        self.publisher = rospy.Publisher(f"{NAMESPACE}/parameters", ActuatorParameters, queue_size=1, latch=True)
        self.publisher.publish(parameters(self.actuator, 0))
        self.said = []
        self.node = subprocess.Popen(
            [rospy.get_param("/follow_parameters_program"), description],
            env={**os.environ, "ROS_NAMESPACE": NAMESPACE, "ROSCONSOLE_STDOUT_LINE_BUFFERED": "1"},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        threading.Thread(target=self._read, daemon=True).start()
        self.addCleanup(self.node.wait)
        self.addCleanup(self.node.terminate)

    def _read(self):
        for line in self.node.stdout:
            self.said.append(line)

    def _line(self, revision, pattern=LINE):
        """What the pattern finds in what is said of a revision."""

        def found():
            of_all = (parts for line in list(self.said) for parts in pattern.findall(line))
            return next((parts for parts in of_all if parts[0] == str(revision)), None)

        return wait_for(found, f"revision {revision}")

    def test_tells_the_strongest_coil_of_each_revision(self):
        self.follow(DESCRIPTION)
        strengths = [torque_at_home(self.actuator, coil) for coil in self.actuator["coils"]]
        _, source, _, strength = self._line(0)
        self.assertEqual(source, "nominal")
        self.assertAlmostEqual(float(strength), max(strengths), delta=1e-8)

        self.publisher.publish(parameters(self.actuator, 1, {6: 3.0}))
        _, _, coil, strength = self._line(1)
        self.assertEqual(int(coil), 7)
        self.assertAlmostEqual(float(strength), 3.0 * strengths[6], delta=1e-8)

    def test_says_that_an_actuator_without_coils_exerts_no_torque(self):
        self.follow(POSITIONER)
        self._line(0, NO_TORQUE)
        self.publisher.publish(parameters(self.actuator, 1))
        self._line(1, NO_TORQUE)


if __name__ == "__main__":
    rospy.init_node("follow_parameters_test")
    rostest.rosrun(PACKAGE, "follow_parameters", FollowParameters, sys.argv)
