#!/usr/bin/python3
"""What run_motion makes those parameters in force that a description states: nothing identified is left behind."""

import copy
import math
import os
import pathlib
import tempfile
import unittest

import yaml
from spherical_actuator_calibration.coil_drive.parameters import parameters_of_file

NOMINAL = pathlib.Path(os.environ["SOURCE"]) / "config" / "pm_spherical_8x24.yaml"


class ParametersOfFile(unittest.TestCase):
    def setUp(self):
        self.actuator = copy.deepcopy(yaml.safe_load(NOMINAL.read_text())["actuator"])

    def message(self):
        with tempfile.NamedTemporaryFile("w", suffix=".yaml") as file:
            yaml.safe_dump({"actuator": self.actuator}, file)
            file.flush()
            return parameters_of_file(file.name, "stator")

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
        self.assertEqual(message.torque_curve.coefficients, curve["coefficients"])
        self.assertEqual(message.torque_curve.blend_start, curve["blend_start"])
        self.assertTrue(message.torque_curve.in_degrees)

    def test_what_is_not_identified_is_not_called_certain(self):
        message = self.message()
        self.assertEqual(message.joints[0].offset_stddev, math.inf)
        self.assertEqual(list(message.joints[0].linear_stddev), [math.inf] * 3)
        self.assertEqual(message.poles[0].azimuth_stddev, math.inf)
        self.assertEqual(message.poles[1].polarity, -1)

    def test_a_table_that_it_cannot_tell_is_refused(self):
        self.actuator["torque_curve"] = {"table": "law.csv"}
        with self.assertRaisesRegex(RuntimeError, "start the laboratory"):
            self.message()


if __name__ == "__main__":
    unittest.main()
