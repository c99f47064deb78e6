#!/usr/bin/python3
"""register_frames against an independent laboratory: its intervals hold what they promise, its error is at the bound,
and a calibration that takes over what it wrote is honest too."""

import os
import subprocess
import tempfile
import unittest

import cases
import laboratory
import numpy as np
import yaml

PROGRAM = os.path.join(os.environ.get("PROGRAMS", "build/devel/lib/spherical_actuator_calibration"), "register_frames")
TOLERANCE = 0.03  # [rad] of manufacture, as configured by default
ORIENTATION, READING = 3e-4, 1e-4  # [rad] standard deviations of tracker and joints
TRIALS, POSES, TILT = 40, 12, 0.5
UNOBSERVABLE = 0.08  # [rad] more than unobservable_stddev
COARSE = 0.0282  # [rad] what a registration by joints as drawn is worth
EXACT_JOINTS = "tolerance: {joint_offset: 0.0, joint_axis: 0.0}\n"


class Trial:
    """A unit, where its tracker and marker sit, and what they measured."""

    def __init__(self, seed, tolerance=TOLERANCE, poses=POSES):
        rng = np.random.default_rng(seed)
        self.unit = laboratory.paper_unit()
        self.errors = np.zeros(self.unit.size())
        self.errors[:9] = rng.normal(0.0, 1.0, 9) * tolerance
        self.tracker = laboratory.rotation(rng.uniform(-1.5, 1.5, 3))
        self.marker = laboratory.rotation(rng.uniform(-1.5, 1.5, 3))
        self.joints = laboratory.random_poses(poses, TILT, rng)
        self.readings = [q + rng.normal(0.0, READING, 3) for q in self.joints]
        self.measured = [self.measure(q, rng) for q in self.joints]
        self.rng = rng

    def measure(self, q, rng):
        """Of the marker in the tracker."""
        noise = laboratory.rotation(rng.normal(0.0, ORIENTATION, 3))
        return self.tracker.T @ noise @ self.unit.orientation(self.errors, q) @ self.marker

    def write(self, path, orientations):
        sensors = laboratory.Laboratory(orientation=ORIENTATION, joint=READING)
        dwells = [laboratory.Dwell(q, R) for q, R in zip(self.readings, orientations)]
        laboratory.write_samples(path, self.unit, sensors, dwells)

    def bound(self):
        """Covariance of both frames with joints that are known."""
        information = np.zeros((6, 6))
        for q in self.joints:
            R = self.unit.orientation(self.errors, q)
            columns = []
            for k in range(3):
                step = np.eye(3)[k] * 1e-6
                turned = self.unit.orientation(self.errors, q + step) @ R.T
                columns.append(laboratory.rotation_vector(turned) / 1e-6)
            turns = np.stack(columns, axis=1)
            noise = ORIENTATION**2 * np.eye(3) + READING**2 * turns @ turns.T
            A = np.hstack([np.eye(3), -R])
            information += A.T @ np.linalg.solve(noise, A)
        return np.linalg.inv(information)


def rotation_of(quaternion):
    x, y, z, w = quaternion
    v = np.array([x, y, z])
    angle = 2.0 * np.arctan2(np.linalg.norm(v), w)
    return laboratory.rotation(v / np.linalg.norm(v) * angle)


class Registered:
    def __init__(self, trial, config=""):
        with tempfile.TemporaryDirectory() as folder:
            paths = [os.path.join(folder, name) for name in ("samples.yaml", "config.yaml", "frames.yaml")]
            trial.write(paths[0], trial.measured)
            with open(paths[1], "w", encoding="utf-8") as file:
                file.write(config or "validation: {hold_out_every: 0}\n")
            answer = subprocess.run(
                [PROGRAM, "--actuator", cases.ACTUATOR, "--samples", paths[0], "--config", paths[1], "--output", paths[2]],
                capture_output=True,
                text=True,
                check=False,
            )
            if answer.returncode != 0:
                raise RuntimeError(answer.stdout + answer.stderr)
            with open(paths[2], encoding="utf-8") as file:
                self.text = yaml.safe_load(file)
        found = self.text["registered_frames"]
        self.tracker = rotation_of(found["stator_tracker"]["quaternion_xyzw"])
        self.marker = rotation_of(found["rotor_marker"]["quaternion_xyzw"])
        self.covariance = np.array(found["covariance"], float)
        self.error = np.concatenate(
            [
                laboratory.rotation_vector(trial.tracker @ self.tracker.T),
                laboratory.rotation_vector(trial.marker @ self.marker.T),
            ]
        )


def shares(errors, stddevs):
    """Share inside 95 %, and root mean square of the normalised errors."""
    normalised = np.abs(np.array(errors) / np.array(stddevs))
    return np.mean(normalised < 1.96), np.sqrt(np.mean(normalised**2))


def whole_calibrations(coarse, seeds):
    """Outcomes of sessions by frames that are known so coarsely [rad], and how far their values are from the truth."""
    unit, sensors = laboratory.paper_unit(), laboratory.Laboratory(registration=(coarse, coarse, 0.0))
    errors, sessions = [], []
    for seed in seeds:
        rng = np.random.default_rng(seed)
        errors.append(rng.normal(0.0, 0.01, unit.size()))
        poses = laboratory.random_poses(40, TILT, rng)
        dwells, _ = laboratory.measured_session(unit, errors[-1], sensors, poses, 8, rng)
        sessions.append((sensors, dwells, 5))
    outcomes = cases.calibrate(unit, sessions, cases.registration_config(sensors.registration))
    return outcomes, np.array([outcome.values - unit.values(e) for outcome, e in zip(outcomes, errors)])


class RegistrationIsHonest(unittest.TestCase):
    def test_joints_as_made_are_common_errors(self):
        results = [Registered(Trial(seed)) for seed in range(TRIALS)]
        stddevs = [np.sqrt(np.diag(result.covariance)) for result in results]
        inside, rms = shares([result.error for result in results], stddevs)
        self.assertGreater(inside, 0.90)
        self.assertLess(inside, 0.99)
        self.assertLess(abs(rms - 1.0), 0.2)
        # All six together: chi-square of six degrees of freedom.
        together = [r.error @ np.linalg.solve(r.covariance, r.error) for r in results]
        self.assertLess(abs(np.mean(together) / 6.0 - 1.0), 0.3)
        # Tolerances rule: noise alone would be a hundredth of it.
        self.assertGreater(np.min(stddevs), 0.3 * TOLERANCE)

    def test_more_poses_tell_no_more_of_what_joints_as_made_leave_open(self):
        results = [Registered(Trial(seed, poses=600)) for seed in range(50, 56)]
        together = [r.error @ np.linalg.solve(r.covariance, r.error) for r in results]
        self.assertLess(np.mean(together) / 6.0, 2.0)
        few = np.sqrt(np.diag(Registered(Trial(50)).covariance))
        many = np.sqrt(np.diag(results[0].covariance))
        self.assertGreater((many / few).min(), 0.9)

    def test_with_joints_that_are_known_it_reaches_the_bound(self):
        trials = [Trial(seed, tolerance=0.0) for seed in range(100, 100 + TRIALS)]
        results = [Registered(trial, EXACT_JOINTS) for trial in trials]
        bounds = [np.sqrt(np.diag(trial.bound())) for trial in trials]
        inside, rms = shares([result.error for result in results], bounds)
        self.assertGreater(inside, 0.90)
        self.assertLess(inside, 0.99)
        self.assertLess(abs(rms - 1.0), 0.15)
        for result, bound in zip(results, bounds):
            scale = np.sqrt(np.diag(result.covariance)) / bound
            self.assertGreater(scale.min(), 0.95)
            # A set of poses that scatters by chance widens its own result.
            self.assertLess(scale.max(), 1.6)

    def test_a_calibration_that_takes_it_over_is_honest(self):
        errors, stddevs = [], []
        for seed in range(200, 200 + TRIALS):
            trial = Trial(seed)
            found = Registered(trial)
            trial.joints = laboratory.random_poses(24, TILT, trial.rng)
            trial.readings = [q + trial.rng.normal(0.0, READING, 3) for q in trial.joints]
            dwells = [
                laboratory.Dwell(reading, found.tracker @ trial.measure(q, trial.rng) @ found.marker.T)
                for q, reading in zip(trial.joints, trial.readings)
            ]
            sensors = laboratory.Laboratory(orientation=ORIENTATION, joint=READING)
            config = cases.registration_config(None, yaml.safe_dump({"registration": found.text["registration"]}))
            (outcome,) = cases.calibrate(trial.unit, [(sensors, dwells, 0)], config)
            self.assertTrue(outcome.cycles[0][1], outcome.cycles[0][2])
            self.assertTrue(outcome.identified[:9].all(), outcome.cycles[0][2])
            errors.append(outcome.values[:9] - trial.errors[:9])
            stddevs.append(outcome.stddevs[:9])
        inside, rms = shares(errors, stddevs)
        self.assertGreater(inside, 0.90)
        self.assertLess(inside, 0.99)
        self.assertLess(abs(rms - 1.0), 0.2)
        # Offsets feel tracker and marker together: independent, or of the wrong sign, they would be 0.55 to 0.7.
        _, rms = shares(*(np.array(each)[:, ::3] for each in (errors, stddevs)))
        self.assertLess(abs(rms - 1.0), 0.2)

    def test_a_whole_calibration_by_frames_as_coarse_as_a_drawing_is_complete(self):
        outcomes, apart = whole_calibrations(COARSE, range(300, 310))
        for outcome in outcomes:
            self.assertTrue(outcome.refined(), outcome.reason)
            self.assertEqual(outcome.grade, "good", outcome.reason)
            self.assertTrue(outcome.identified.all())
            # A common turn is known as well as the frames, what lies between the axes by what was measured.
            self.assertGreater(outcome.stddevs[:9].max(), 0.9 * COARSE)
            self.assertLess(outcome.stddevs.max(), 1.5 * COARSE)
        inside, rms = shares(apart, [outcome.stddevs for outcome in outcomes])
        self.assertGreater(inside, 0.8)
        self.assertLess(rms, 1.3)

    def test_frames_that_leave_a_turn_unobservable_are_told_and_bend_nothing(self):
        outcomes, apart = whole_calibrations(UNOBSERVABLE, range(320, 328))
        stddevs = np.array([outcome.stddevs for outcome in outcomes])
        for outcome in outcomes:
            self.assertTrue(outcome.refined(), outcome.reason)
            self.assertNotEqual(outcome.grade, "good", outcome.reason)
            self.assertFalse(outcome.identified.all())
        self.assertLess(np.abs(apart / stddevs).max(), 4.0)

    def test_argument_of_the_launch_file_is_what_was_found(self):
        found = Registered(Trial(1)).text
        for name in ("stator_tracker", "rotor_marker"):
            words = [float(word) for word in found["launch"][name].split()]
            self.assertEqual(words[:3], [0.0, 0.0, 0.0])
            np.testing.assert_allclose(words[3:], found["registered_frames"][name]["quaternion_xyzw"], atol=1e-11)


if __name__ == "__main__":
    unittest.main()
