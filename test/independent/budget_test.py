#!/usr/bin/python3
"""Does the uncertainty budget tell what a better sensor would be worth?

A share is the slope of the variance by that of its source, both on logarithmic scales: of the best estimate, whose weights
need not be changed for it. The bound of laboratory.py is calculated anew with each source 0.1 % larger and smaller.
"""

import os
import pathlib
import subprocess
import tempfile
import unittest

import cases
import laboratory
import numpy as np
import yaml

PROGRAMS = pathlib.Path(os.environ["PROGRAMS"])
SENSORS = laboratory.Laboratory(joint=3e-4, zero_current=4e-4, registration=(5e-4, 1e-3, 8e-4))
STEP = 1.001
SOURCES = ("orientation", "torque", "joint_reading", "torque_without_current", "tracker_registration", "marker_registration",
           "torque_registration")


class Bound:
    """Variances of the parameters by standard deviations of the sources, in the order of SOURCES."""

    def __init__(self, unit, errors, dwells):
        self.size, self.dwells = unit.size(), dwells
        self.jacobians = [self.jacobian(unit, errors, dwell) for dwell in dwells]

    def jacobian(self, unit, errors, dwell):
        x = np.concatenate([errors, np.zeros(18)])  # no drift of the bias: the last three
        steps = 1e-6 * np.eye(len(x))[: self.size + 15]
        return np.stack(
            [
                (laboratory.predicted(unit, x + step, dwell) - laboratory.predicted(unit, x - step, dwell)) / 2e-6
                for step in steps
            ],
            axis=1,
        )

    def variances(self, stddevs):
        orientation, torque, reading, bias = stddevs[:4]
        shared = self.size + 9
        information = np.zeros((shared, shared))
        for dwell, J in zip(self.dwells, self.jacobians):
            noise = np.diag([orientation**2] * 3 + [torque**2] * (3 * len(dwell.torques)))
            V = noise + J[:, shared:] @ np.diag(np.repeat([reading, bias], 3) ** 2) @ J[:, shared:].T
            information += J[:, :shared].T @ np.linalg.solve(V, J[:, :shared])
        information[self.size :, self.size :] += np.diag(1.0 / np.repeat(stddevs[4:], 3) ** 2)
        return np.diag(np.linalg.inv(information))[: self.size]

    def shares(self, stddevs):
        """Parameters x sources."""
        columns = []
        for n in range(len(stddevs)):
            more, less = np.array(stddevs), np.array(stddevs)
            more[n] *= STEP
            less[n] /= STEP
            columns.append((np.log(self.variances(more)) - np.log(self.variances(less))) / (4.0 * np.log(STEP)))
        return np.stack(columns, axis=1)


class BudgetTest(unittest.TestCase):
    def test_shares_are_slopes(self):
        unit, rng = laboratory.paper_unit(), np.random.default_rng(3)
        errors = rng.uniform(-0.02, 0.02, unit.size())
        dwells, _ = laboratory.measured_session(unit, errors, SENSORS, laboratory.random_poses(12, 0.5, rng), 12, rng)
        told = self.calibrated(unit, dwells)
        rows = [told["names"].index(name) for name in unit.names()]
        bound = Bound(unit, errors, dwells)
        stddevs = [SENSORS.orientation, SENSORS.torque, SENSORS.joint, SENSORS.zero_current, *SENSORS.registration]
        stated = np.sqrt(np.diag(np.array(told["matrix"]))[rows])
        np.testing.assert_allclose(stated / np.sqrt(bound.variances(stddevs)), 1.0, atol=0.01)
        columns = [told["budget"]["sources"].index(source) for source in SOURCES]
        shares = np.array(told["budget"]["shares"])
        np.testing.assert_allclose(shares[np.ix_(rows, columns)], bound.shares(stddevs), atol=0.005)
        np.testing.assert_allclose(shares.sum(axis=1), 1.0, atol=1e-9)

    def calibrated(self, unit, dwells):
        """What the file of the covariance says."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            laboratory.write_samples(folder / "samples.yaml", unit, SENSORS, dwells)
            config = cases.registration_config(SENSORS.registration, "validation: {hold_out_every: 0}\n")
            (folder / "config.yaml").write_text(config, encoding="utf-8")
            self.run_program("samples_to_bag", "--samples", folder / "samples.yaml", "--output", folder / "samples.bag")
            self.run_program("calibrate_bag", "--config", folder / "config.yaml", "--output", folder / "calibrated.yaml",
                             "--covariance", folder / "covariance.yaml", folder / "samples.bag")
            return yaml.safe_load((folder / "covariance.yaml").read_text(encoding="utf-8"))["covariance"]

    def run_program(self, program, *arguments):
        command = [PROGRAMS / program, "--actuator", cases.ACTUATOR, *arguments]
        subprocess.run([str(word) for word in command], stdout=subprocess.DEVNULL, check=True)


if __name__ == "__main__":
    unittest.main()
