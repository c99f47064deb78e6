#!/usr/bin/python3
"""The module for Python says what predict says, and its currents make the torque that was asked for."""

import csv
import os
import subprocess
import tempfile
import unittest

from spherical_actuator_calibration.calibrated_actuator import CalibratedActuator

PROGRAMS = os.environ["PROGRAMS"]
SOURCE = os.environ["SOURCE"]
NOMINAL = os.path.join(SOURCE, "config", "pm_spherical_8x24.yaml")
JOINTS, TORQUE = [0.1, -0.2, 0.7], [0.05, -0.03, 0.04]


def opened(description):
    return CalibratedActuator(description, os.path.join(PROGRAMS, "actuator_model"))


class Asked(unittest.TestCase):
    def test_the_same_as_predict(self):
        with tempfile.TemporaryDirectory() as folder, opened(NOMINAL) as actuator:
            currents = [0.01 * coil for coil in range(actuator.coils)]
            paths = {name: os.path.join(folder, name) for name in ("joints", "currents", "output")}
            for name, row in (("joints", JOINTS), ("currents", currents)):
                with open(paths[name], "w", encoding="utf-8") as file:
                    file.write(",".join(map(repr, row)) + "\n")
            options = [word for name, path in paths.items() for word in (f"--{name}", path)]
            subprocess.run(
                [os.path.join(PROGRAMS, "predict"), "--actuator", NOMINAL, *options], check=True, stdout=subprocess.DEVNULL
            )
            with open(paths["output"], encoding="utf-8") as file:
                expected = [float(word) for word in next(csv.reader(file))]
            pose, made = actuator.orientation(JOINTS), actuator.torque(JOINTS, currents)
            self.assertEqual([*pose.quaternion_xyzw, pose.stddev, *made.torque, made.stddev], expected)
            self.assertFalse(actuator.has_uncertainty)

    def test_currents_make_the_torque_within_their_limit(self):
        with opened(NOMINAL) as actuator:
            found = actuator.currents(TORQUE, JOINTS)
            self.assertEqual((found.outcome, len(found.currents), len(found.stddevs)), ("reached", 24, 24))
            for wanted, made in zip(TORQUE, actuator.torque(JOINTS, found.currents).torque):
                self.assertAlmostEqual(wanted, made, 12)
            limited = actuator.currents(TORQUE, JOINTS, limit=0.01)
            self.assertEqual(limited.outcome, "limited")
            self.assertLessEqual(max(map(abs, limited.currents)), 0.01 + 1e-12)

    def test_what_is_wrong_is_told_and_the_next_question_answered(self):
        with opened(NOMINAL) as actuator:
            with self.assertRaisesRegex(ValueError, "5 numbers where 27 belong"):
                actuator.torque(JOINTS, [0.0, 0.0])
            with self.assertRaisesRegex(ValueError, "not finite|is no number"):
                actuator.orientation([float("nan"), 0.0, 0.0])
            self.assertAlmostEqual(sum(q * q for q in actuator.orientation(JOINTS).quaternion_xyzw), 1.0, 12)
        with self.assertRaisesRegex(ValueError, "no_such.yaml"):
            opened("no_such.yaml")


if __name__ == "__main__":
    unittest.main()
