#!/usr/bin/python3
"""A coil that moves after a calibration: whatever is measured and refined then, it is not called good again."""

import os
import subprocess
import tempfile
import unittest

import cases
import laboratory
import numpy as np

PROGRAMS = os.environ.get("PROGRAMS", "build/devel/lib/spherical_actuator_calibration")
SENSORS = laboratory.Laboratory(orientation=6e-5, torque=1.5e-4)
SEED = 23
POSES = 24
COILS_PER_POSE = 8
TOLERANCE = 0.02  # [rad]
REGISTERED = """
registration:
  stator_tracker: {stddev: 1.0e-6}
  rotor_marker: {stddev: 1.0e-6}
  rotor_ft_sensor: {stddev: 1.0e-6}
"""


def run(program, *arguments):
    command = [os.path.join(PROGRAMS, program), *arguments]
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)


class MovedCoil(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.unit = laboratory.paper_unit()

    def setUp(self):
        self.rng = np.random.default_rng(SEED)
        self.errors = self.rng.uniform(-TOLERANCE, TOLERANCE, self.unit.size())
        poses = laboratory.random_poses(POSES, 0.3, self.rng)
        self.dwells, _ = laboratory.measured_session(self.unit, self.errors, SENSORS, poses, COILS_PER_POSE, self.rng)
        self.dwells += self.every_coil(self.errors, held_out=True)

    def pose_of(self, coil):
        """One at which it is among the coils that tell most."""
        while True:
            (pose,) = laboratory.random_poses(1, 0.3, self.rng)
            if coil in laboratory.coils_in_reach(self.unit, pose, 2):
                return pose

    def every_coil(self, errors, held_out):
        """A dwell with each coil on once."""
        return [self.captured(errors, coil, held_out) for coil in range(len(self.unit.coils))]

    def captured(self, errors, coil, held_out):
        pose = self.pose_of(coil)
        R = self.unit.orientation(errors, pose)
        turned = laboratory.rotation(self.rng.normal(0.0, SENSORS.orientation, 3))
        torque = self.unit.torque(errors, R, {coil: 2.0}) + self.rng.normal(0.0, SENSORS.torque, 3)
        return laboratory.Dwell(pose, turned @ R, [({coil: 2.0}, torque)], held_out)

    def moved(self, coil, by):
        errors = self.errors.copy()
        errors[9 + 2 * len(self.unit.poles) + 2 * coil] += by
        return errors

    def calibrate(self, *further):
        """What calibrate_bag says of the session, and of what was captured since."""
        with tempfile.TemporaryDirectory() as folder:
            samples, bag = os.path.join(folder, "samples.yaml"), os.path.join(folder, "samples.bag")
            config = os.path.join(folder, "calibration.yaml")
            with open(config, "w", encoding="utf-8") as file:
                file.write(REGISTERED)
            laboratory.write_samples(samples, self.unit, SENSORS, [*self.dwells, *further])
            made = run("samples_to_bag", "--actuator", cases.ACTUATOR, "--samples", samples, "--output", bag)
            self.assertEqual(made.returncode, 0, made.stdout)
            return run("calibrate_bag", "--actuator", cases.ACTUATOR, "--config", config, "--cycles", "joint,refine", bag).stdout

    def grade(self, said):
        return next(line.split()[1] for line in said.splitlines() if line.startswith("grade: "))

    def test_nothing_moved(self):
        said = self.calibrate(*self.every_coil(self.errors, held_out=True))
        self.assertEqual(self.grade(said), "good", said)
        self.assertIn("they agree", said)

    def test_shows_beside_many_that_did_not(self):
        said = self.calibrate(*self.every_coil(self.moved(4, 1.5e-3), held_out=True))
        self.assertEqual(self.grade(said), "contradicted", said)
        self.assertIn("by coil 5 (chi-square", said)

    def test_is_not_excused_by_what_a_refinement_rejects(self):
        moved = self.moved(10, 20e-3)
        held_out = self.every_coil(moved, held_out=True)
        said = self.calibrate(*held_out, *self.every_coil(moved, held_out=False), self.captured(moved, 10, True))
        self.assertIn("rejected as outliers", said)
        self.assertEqual(self.grade(said), "contradicted", said)
        self.assertIn("coil 11 (chi-square", said)

    def test_is_not_excused_by_a_glitch_of_another_coil(self):
        current, torque = self.dwells[3].torques[2]
        self.dwells[3].torques[2] = current, torque + np.array([0.03, 0.0, 0.0])
        self.dwells = self.dwells[:POSES]
        held_out = self.every_coil(self.moved(7, 20e-3), held_out=True)
        said = self.calibrate(*held_out)
        self.assertEqual(self.grade(said), "usable", said)
        self.assertIn("coil 8", said[said.index("Validation:") :])


if __name__ == "__main__":
    unittest.main()
