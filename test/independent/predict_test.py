#!/usr/bin/python3
"""calibrate_bag, then predict: a real machine at poses that the calibration has not seen, and the same numbers as an
independent model."""

import os
import subprocess
import tempfile
import unittest

import numpy as np
import yaml
from described_rotor import DescribedRotor, matrix_of
from laboratory import quaternion_xyzw, rotation, rotation_vector

PROGRAMS = os.environ["PROGRAMS"]
POSITIONER = os.path.join(os.environ["SOURCE"], "config", "examples", "two_axis_positioner")
ACTUATOR = os.path.join(POSITIONER, "actuator.yaml")
FOLDS = 4


def run(name, *arguments):
    result = subprocess.run([os.path.join(PROGRAMS, name), *arguments], capture_output=True, text=True, check=False)
    if result.returncode == 2:
        raise RuntimeError(result.stderr)
    return result.stdout


def real_samples():
    with open(os.path.join(POSITIONER, "samples.yaml"), encoding="utf-8") as file:
        return yaml.safe_load(file)


class Calibration:
    """Of some of the real samples."""

    def __init__(self, folder, samples, *options):
        self.folder = folder
        self.description = os.path.join(folder, "calibrated.yaml")
        recording, listed = os.path.join(folder, "s.bag"), os.path.join(folder, "s.yaml")
        with open(listed, "w", encoding="utf-8") as file:
            yaml.safe_dump({"orientation_stddev": 5.0e-4, "samples": samples}, file)
        run("samples_to_bag", "--actuator", ACTUATOR, "--samples", listed, "--output", recording, "--force")
        self.said = run(
            "calibrate_bag", "--actuator", ACTUATOR, "--output", self.description, "--force", *options, recording
        )

    def loaded(self):
        with open(self.description, encoding="utf-8") as file:
            return yaml.safe_load(file)

    def predict(self, joints):
        """Quaternions and standard deviations."""
        asked, answered = os.path.join(self.folder, "q.csv"), os.path.join(self.folder, "r.csv")
        np.savetxt(asked, joints, delimiter=",", fmt="%.17g")
        self.told = run(
            "predict", "--actuator", self.description, "--joints", asked, "--output", answered, "--force"
        )
        rows = np.loadtxt(answered, delimiter=",", ndmin=2)
        return rows[:, :4], rows[:, 4]


def errors_of(calibration, samples):
    """Rotation errors, a row each, and their stated standard deviations."""
    quaternions, stddevs = calibration.predict([sample["joint_position"] for sample in samples])
    errors = [
        rotation_vector(matrix_of(sample["orientation_xyzw"]) @ matrix_of(quaternion).T)
        for sample, quaternion in zip(samples, quaternions)
    ]
    return np.array(errors), stddevs


class RealPositioner(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.samples = real_samples()["samples"]

    def cross_validated(self, folds, *options):
        """folds: a number for each sample; each is predicted from those of other numbers."""
        errors, stddevs = [], []
        for fold in np.unique(folds):
            known = [sample for sample, of in zip(self.samples, folds) if of != fold]
            unseen = [sample for sample, of in zip(self.samples, folds) if of == fold]
            e, s = errors_of(Calibration(self.folder.name, known, *options), unseen)
            errors.append(e)
            stddevs.append(s)
        return np.concatenate(errors), np.concatenate(stddevs)

    def drawn(self):
        """Quarters, evenly over the workspace."""
        return np.arange(len(self.samples)) % FOLDS

    def regions(self):
        """Eight of neighbours: halved three times, along the joint of the widest spread."""
        joints = np.array([sample["joint_position"] for sample in self.samples])
        joints /= np.maximum(np.ptp(joints, axis=0), 1e-6)
        regions = [np.arange(len(joints))]
        for _ in range(3):
            widest = [joints[r, np.argmax(np.ptp(joints[r], axis=0))] for r in regions]
            sorted_ones = [r[np.argsort(w, kind="stable")] for r, w in zip(regions, widest)]
            regions = [half for r in sorted_ones for half in np.split(r, [len(r) // 2])]
        return np.array([next(n for n, r in enumerate(regions) if s in r) for s in range(len(joints))])

    def expect_good(self, folds, largest_rms, *options):
        errors, stddevs = self.cross_validated(folds, *options)
        rms = np.sqrt(np.mean(np.sum(errors**2, axis=1)))
        inside = np.mean(np.abs(errors) < 1.96 * stddevs[:, None])
        print(f"{options}: {1e3 * rms:.3f} mrad rms, {100.0 * inside:.1f} % inside")
        self.assertLess(rms, largest_rms)
        self.assertGreater(inside, 0.91)
        self.assertLess(inside, 0.98)

    def test_is_predicted_where_it_was_not_seen(self):
        self.expect_good(self.drawn(), 0.55e-3)

    def test_a_region_is_predicted_from_its_neighbours(self):
        self.expect_good(self.regions(), 0.60e-3)

    def test_is_predicted_with_its_own_configuration(self):
        self.expect_good(self.drawn(), 0.55e-3, "--config", os.path.join(POSITIONER, "calibration.yaml"))

    def test_axes_alone_predict_it_worse(self):
        path = os.path.join(self.folder.name, "axes.yaml")
        with open(path, "w", encoding="utf-8") as file:
            file.write("orientation_map: {use: never}\n")
        errors, _ = self.cross_validated(self.drawn(), "--config", path)
        self.assertGreater(np.sqrt(np.mean(np.sum(errors**2, axis=1))), 0.8e-3)

    def test_far_from_what_was_seen_the_axes_tell_and_it_is_said(self):
        known = [sample for sample in self.samples if sample["joint_position"][1] < 3.5]
        calibration = Calibration(self.folder.name, known)
        loaded = calibration.loaded()
        self.assertIn("orientation_map", loaded["actuator"], calibration.said)
        far = [[0.0, 4.9, 0.0]]
        quaternions, stddevs = calibration.predict(far)
        self.assertIn("1 of 1 poses lie away", calibration.told)
        del loaded["actuator"]["orientation_map"]
        axes = DescribedRotor(loaded).orientation(np.array(far[0]))
        self.assertLess(np.linalg.norm(rotation_vector(matrix_of(quaternions[0]) @ axes.T)), 0.3e-3)
        near = calibration.predict([known[0]["joint_position"]])[1]
        self.assertGreater(stddevs[0], 1.5 * near[0])


class BentMachine(unittest.TestCase):
    """Not real: known where it is, so that intervals of the rotor itself can be judged, not of a tracker beside it."""

    def bent(self, q):
        with open(ACTUATOR, encoding="utf-8") as file:
            axes = DescribedRotor(yaml.safe_load(file)).orientation(q)
        turned = np.array([np.sin(3.0 * q[0]), np.cos(1.5 * q[1]), np.sin(q[1] + 2.0 * q[0])])
        return rotation(1.0e-3 * turned) @ axes

    def test_intervals_of_the_rotor_hold_what_its_tracker_does_not_blur(self):
        rng = np.random.default_rng(7)
        joints = rng.uniform([-0.5, 0.0, 0.0], [0.5, 6.0, 0.0], (300, 3))
        known = [
            {
                "joint_position": q.tolist(),
                "orientation_xyzw": quaternion_xyzw(rotation(rng.normal(0.0, 5.0e-4, 3)) @ self.bent(q)).tolist(),
            }
            for q in joints[:120]
        ]
        with tempfile.TemporaryDirectory() as folder:
            calibration = Calibration(folder, known)
            self.assertIn("orientation_map", calibration.loaded()["actuator"], calibration.said)
            quaternions, stddevs = calibration.predict(joints[120:])
        errors = [
            rotation_vector(self.bent(q) @ matrix_of(quaternion).T) for q, quaternion in zip(joints[120:], quaternions)
        ]
        scaled = np.array(errors) / stddevs[:, None]
        print(f"normalised rms of the rotor {np.sqrt(np.mean(scaled**2)):.2f}, ±{1e3 * np.median(stddevs):.3f} mrad")
        self.assertGreater(np.sqrt(np.mean(scaled**2)), 0.6)  # 0.27 with the noise of the tracker
        self.assertLess(np.sqrt(np.mean(scaled**2)), 1.25)


class SameNumbers(unittest.TestCase):
    def expect_same(self, *options):
        with tempfile.TemporaryDirectory() as folder:
            calibration = Calibration(folder, real_samples()["samples"], *options)
            loaded = calibration.loaded()
            rotor = DescribedRotor(loaded)
            joints = np.random.default_rng(1).uniform([-0.5, 0.0, -0.02], [0.5, 6.0, 0.02], (20, 3))
            for q, quaternion, stddev in zip(joints, *calibration.predict(joints)):
                apart = rotation_vector(matrix_of(quaternion) @ rotor.orientation(q).T)
                self.assertLess(np.linalg.norm(apart), 1e-10)
                expected = rotor.stddev(q, loaded["actuator"]["calibration"]["covariance"])
                self.assertLess(abs(stddev / expected - 1.0), 1e-3)
            return loaded["actuator"]

    def test_with_a_map(self):
        self.assertIn("orientation_map", self.expect_same())

    def test_with_every_correction_of_readings(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "all.yaml")
            with open(path, "w", encoding="utf-8") as file:
                file.write("effects: {tilt_cross_axis: true, encoder_harmonics: [1, 2]}\n")
            joints = self.expect_same("--config", path)["joints"]
        self.assertTrue(any(joints[0]["linear"]))
        self.assertTrue(all(joints[0]["harmonics"]))
        self.assertTrue(all(joints[1]["harmonics"]))
        self.assertNotIn("harmonics", joints[2])


if __name__ == "__main__":
    unittest.main()
