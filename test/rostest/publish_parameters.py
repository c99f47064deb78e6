#!/usr/bin/python3
"""The node publish_parameters: nothing that a description states is left behind, and run_motion controls by it."""

import copy
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import rospy
import rostest
import yaml
from calibration_client import DEADLINE, NAMESPACE, PACKAGE, program
from spherical_actuator_calibration.coil_drive.parameters import parameters_in_force
from spherical_actuator_calibration.msg import ActuatorParameters

NOMINAL = pathlib.Path(__file__).resolve().parents[2] / "config" / "pm_spherical_8x24.yaml"


class PublishParameters(unittest.TestCase):
    def setUp(self):
        self.actuator = copy.deepcopy(yaml.safe_load(NOMINAL.read_text())["actuator"])
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = os.path.join(folder.name, "calibrated.yaml")

    def write(self):
        with open(self.path, "w", encoding="utf-8") as file:
            yaml.safe_dump({"actuator": self.actuator}, file)

    def message(self):
        self.write()
        with parameters_in_force(NAMESPACE, self.path):
            return rospy.wait_for_message(f"{NAMESPACE}/parameters", ActuatorParameters, DEADLINE)

    def test_everything_identified_is_in_the_message(self):
        joint = self.actuator["joints"][1]
        joint["linear"], joint["harmonics"] = [0.0, 1e-3, 2e-3], [1e-4, 2e-4, 3e-4, 4e-4]
        joint["stddev"] = {"offset": 1e-5, "axis_u": 2e-5, "axis_v": 3e-5, "harmonics": [5e-5] * 4}
        self.actuator["coils"][2].update(gain=1.02, stddev={"polar": 4e-5})
        self.actuator["rotor_unbalance"] = [0.003, -0.004, 0.002]
        self.actuator["orientation_map"] = {
            "length": [0.5, 0.6, 0.7],
            "amplitude": [1e-3, 2e-3, 3e-3],
            "noise": [1e-4, 2e-4, 3e-4],
            "points": [{"reading": [0.1, 0.2, 0.3], "rotation": [1e-3, 0.0, -1e-3]}],
        }
        message = self.message()
        self.assertEqual(message.actuator, self.actuator["name"])
        self.assertEqual(message.header.frame_id, "stator")
        found = message.joints[1]
        self.assertEqual(list(found.linear), joint["linear"])
        self.assertEqual(list(found.harmonics), joint["harmonics"])
        self.assertEqual([found.offset_stddev, *found.axis_stddev], [1e-5, 2e-5, 3e-5])
        self.assertEqual(list(found.harmonics_stddev), [5e-5] * 4)
        self.assertEqual(message.coils[2].gain, 1.02)
        self.assertEqual(message.coils[2].polar_stddev, 4e-5)
        self.assertEqual([message.unbalance.x, message.unbalance.y, message.unbalance.z], [0.003, -0.004, 0.002])
        self.assertEqual(list(message.orientation_map.length), [0.5, 0.6, 0.7])
        self.assertEqual(message.orientation_map.readings[0].z, 0.3)
        self.assertEqual(message.orientation_map.rotations[0].z, -1e-3)
        curve = self.actuator["torque_curve"]
        self.assertEqual(list(message.torque_curve.coefficients), curve["coefficients"])
        self.assertEqual(message.torque_curve.blend_start, curve["blend_start"])
        self.assertTrue(message.torque_curve.in_degrees)

    def test_what_is_not_identified_is_not_called_certain(self):
        message = self.message()
        self.assertEqual(message.source, ActuatorParameters.NOMINAL)
        self.assertEqual(message.joints[0].offset_stddev, math.inf)
        self.assertEqual(list(message.joints[0].linear_stddev), [math.inf] * 3)
        self.assertEqual(message.poles[0].azimuth_stddev, math.inf)
        self.assertEqual(message.poles[1].polarity, -1)

    def test_a_torque_law_in_a_file_beside_it_is_read(self):
        with open(os.path.join(os.path.dirname(self.path), "law.csv"), "w", encoding="utf-8") as file:
            file.write("0,0\n6,0.05\n17,0.2\n26,0.1\n32,0\n")
        self.actuator["torque_curve"] = {"table": "law.csv"}
        self.assertEqual(list(self.message().torque_curve.table_torques), [0.0, 0.05, 0.2, 0.1, 0.0])

    def test_a_description_that_is_none_ends_it(self):
        self.actuator["poles"][3]["polarity"] = 2
        self.write()
        command = [program("publish_parameters"), "__name:=without_description", f"_description:={self.path}"]
        ended = subprocess.run(command, stderr=subprocess.PIPE, text=True, check=False, timeout=DEADLINE)
        self.assertEqual(ended.returncode, 1)
        self.assertIn("poles[3].polarity", ended.stderr)
        with self.assertRaisesRegex(RuntimeError, "do not come"):
            with parameters_in_force(NAMESPACE, self.path):
                pass


if __name__ == "__main__":
    rospy.init_node("publish_parameters_test")
    rostest.rosrun(PACKAGE, "publish_parameters", PublishParameters, sys.argv)
