#!/usr/bin/python3
"""Whether torque is proportional to current, as calibrate_bag tells it of recorded streams whose torques bend or not."""

import os
import pathlib
import subprocess
import tempfile
import types
import unittest

import laboratory
import numpy as np
import recorded_dwells
import yaml

PROGRAM = pathlib.Path(os.environ["PROGRAMS"]) / "calibrate_bag"
ACTUATOR = pathlib.Path(os.environ["SOURCE"]) / "config" / "pm_spherical_8x24.yaml"
UNITS = int(os.environ.get("UNITS", "12"))
FULL = 2.0  # [A]
CURRENT_STDDEV = 5e-4  # [A] of a measured current, as doc/method.md has it
STREAMS = recorded_dwells.Streams(torque=5e-4)


def rest_with(unit, errors, q, currents, saturation, rng):
    """A rest with the coil of the largest torque at these currents: at the largest it makes less by the saturation."""
    R = unit.orientation(errors, q)
    coil = max(range(len(unit.coils)), key=lambda j: np.linalg.norm(unit.torque(errors, R, {j: 1.0})))
    torques = [np.zeros(3)]
    patterns = [{}]
    for ampere in currents:
        torques.append(unit.torque(errors, R, {coil: ampere}) * (1.0 - saturation * abs(ampere) / FULL))
        patterns.append({coil: ampere + rng.normal(0.0, CURRENT_STDDEV)})
    return types.SimpleNamespace(q=q, R=R, patterns=patterns, torques=torques)


class TorqueLinearity(unittest.TestCase):
    def told(self, currents, saturation, seed):
        """What the report tells, and what the program prints."""
        unit, rng = laboratory.paper_unit(), np.random.default_rng(seed)
        errors = rng.uniform(-0.02, 0.02, unit.size())
        with tempfile.TemporaryDirectory() as folder:
            bag, report = os.path.join(folder, "rest.bag"), os.path.join(folder, "report")
            recorder = recorded_dwells.Recorder(bag, unit, STREAMS, rng)
            for q in laboratory.random_poses(1, 0.5, rng):
                rest = rest_with(unit, errors, q, currents, saturation, rng)
                recorder.move_to(rest)
                recorder.rest_at(rest)
            recorder.close()
            result = subprocess.run(
                [PROGRAM, "--actuator", ACTUATOR, "--from", "streams", "--cycles", "coils", "--report", report, "--no-page"]
                + ["--output", os.path.join(folder, "calibrated.yaml"), bag],
                capture_output=True,
                text=True,
                check=False,
            )
            # One rest calibrates nothing.
            self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
            with open(os.path.join(report, "report.yaml"), encoding="utf-8") as file:
                return yaml.safe_load(file)["calibration_report"], result.stdout

    def judged(self, saturation):
        """Errors in standard deviations, and the probabilities, of several units."""
        errors, probabilities = [], []
        for seed in range(UNITS):
            linearity = self.told((FULL, 0.5 * FULL, -FULL), saturation, seed)[0]["torque_linearity"]
            self.assertTrue(linearity["told"])
            deviation = linearity["deviation"]
            self.assertLess(deviation["stddev"], 0.004)
            errors.append((deviation["value"] + saturation) / deviation["stddev"])
            errors.append(linearity["asymmetry"]["value"] / linearity["asymmetry"]["stddev"])
            probabilities.append(linearity["probability"])
        spread = np.sqrt(np.mean(np.square(errors)))
        print(f"saturation {saturation}: {UNITS} units, normalised rms {spread:.2f}, largest {np.max(np.abs(errors)):.2f}")
        self.assertLess(np.max(np.abs(errors)), 3.5)
        self.assertTrue(0.5 < spread < 1.4, spread)
        return probabilities

    def test_a_saturation_of_2_percent_is_told(self):
        self.assertLess(max(self.judged(0.02)), 1e-3)

    def test_a_torque_in_proportion_is_not_accused(self):
        probabilities = self.judged(0.0)
        self.assertGreater(min(probabilities), 1e-3)
        self.assertGreater(max(probabilities), 0.2)

    def test_is_not_told_by_one_current(self):
        report, said = self.told((FULL,), 0.02, 1)
        self.assertEqual(report["torque_linearity"]["told"], False)
        self.assertIn("measure one coil at three currents", report["torque_linearity"]["sentence"])
        self.assertNotIn("Torque is", said)


if __name__ == "__main__":
    unittest.main()
