#!/usr/bin/python3
"""An actuator of 4 poles and 6 coils by its description alone: planned, measured, calibrated, predicted, and judged by
a model of its own; its torque curve as a polynomial, and as a table of 40 points that was made of it."""

import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np
import yaml

PROGRAMS = pathlib.Path(os.environ["PROGRAMS"])
COEFFICIENTS = [-5.40e-3, 2.59e-2, -9.325e-7, -5.25e-5, 1.49375e-6, -1.584375e-8, 5.90625e-11]  # of degrees
BLEND_START, SUPPORT = 4.0, [56.0, 64.0]  # [deg]
POSES = [[0.1, 0.2, 0.3], [-0.3, 0.1, 1.0]]
CURRENTS = [[1.0, -2.0, 0.5, 0.0, 1.0, 2.0], [2.0, 0.0, 0.0, 1.0, 0.0, -1.0]]


def drawing(curve):
    return {
        "name": "four_by_six",
        "serial": "own-1",
        "joints": [{"name": f"joint_{n + 1}", "axis": axis, "offset": 0.0} for n, axis in enumerate(np.eye(3).tolist())],
        "poles": [{"polar": 0.0, "azimuth": n * np.pi / 2.0, "polarity": (-1) ** n} for n in range(4)],
        "coils": [{"polar": 0.35 * (-1) ** n, "azimuth": n * np.pi / 3.0} for n in range(6)],
        "torque_curve": {"angle_unit": "deg", "blend_start": BLEND_START, "support": SUPPORT, **curve},
        "workspace": {"tilt_limit": 0.6},
    }


def turned(axis, angle):
    """Rodrigues' formula."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross


def direction(angles):
    polar, azimuth = angles["polar"], angles["azimuth"]
    return np.array([np.cos(polar) * np.cos(azimuth), np.cos(polar) * np.sin(azimuth), np.sin(polar)])


def strength(angle):
    """Torque per ampere at an angle [rad] between pole and coil, as doc/method.md tells the curve."""
    at, polynomial = np.degrees(angle), np.polynomial.Polynomial(COEFFICIENTS)
    begin, (end, zero) = BLEND_START, SUPPORT
    if at < begin:
        powers = [[begin, begin**3], [1.0, 3.0 * begin**2]]
        return np.linalg.solve(powers, [polynomial(begin), polynomial.deriv()(begin)]) @ [at, at**3]
    if at <= end:
        return polynomial(at)
    if at >= zero:
        return 0.0
    left = zero - at  # a cubic whose value and slope are zero where nothing is left
    width = zero - end
    powers = [[width**2, width**3], [-2.0 * width, -3.0 * width**2]]
    return np.linalg.solve(powers, [polynomial(end), polynomial.deriv()(end)]) @ [left**2, left**3]


def orientation(unit, joints):
    rotation = np.eye(3)
    for joint, angle in zip(unit["joints"], joints):
        rotation = rotation @ turned(joint["axis"], angle + joint["offset"])
    return rotation


def torque(unit, rotation, currents):
    """Of the coils on the rotor, rotor frame."""
    total = np.zeros(3)
    for coil, current in zip(unit["coils"], currents):
        coil_axis = rotation.T @ direction(coil)
        for pole in unit["poles"]:
            pole_axis = direction(pole)
            normal = np.cross(pole_axis, coil_axis)
            sine = np.linalg.norm(normal)
            per_ampere = strength(np.arctan2(sine, pole_axis @ coil_axis))
            total += pole["polarity"] * current * per_ampere / sine * normal
    return total


class DescriptionAlone(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.write("drawn.yaml", drawing({"coefficients": COEFFICIENTS}))
        degrees = np.linspace(BLEND_START, SUPPORT[0], 40)
        points = np.column_stack([degrees, np.polynomial.polynomial.polyval(degrees, COEFFICIENTS)])
        # As a spreadsheet saves it: a mark of the byte order, names, ends of lines of two characters.
        with open(cls.folder / "curve.csv", "w", encoding="utf-8-sig", newline="\r\n") as file:
            np.savetxt(file, points, delimiter=",", fmt="%.17g", header="angle,torque", comments="")
        cls.write("tabled.yaml", drawing({"table": "curve.csv"}))
        cls.planned = cls.run_program(
            "plan_session", "--actuator", "drawn.yaml", "--poses", "10", "--output", "plan.yaml"
        )
        cls.run_program("simulate_recording", "--actuator", "drawn.yaml", "--plan", "plan.yaml", "--output", "s.bag")
        for name in ("drawn", "tabled"):
            cls.run_program("calibrate_bag", "--actuator", f"{name}.yaml", "--output", f"{name}_unit.yaml", "s.bag")

    @classmethod
    def write(cls, name, actuator):
        (cls.folder / name).write_text(yaml.safe_dump({"actuator": actuator}))

    @classmethod
    def run_program(cls, name, *arguments):
        done = subprocess.run([PROGRAMS / name, *arguments], cwd=cls.folder, capture_output=True, text=True, check=False)
        if done.returncode not in (0, 1):
            raise RuntimeError(done.stdout + done.stderr)
        return done.stdout

    @classmethod
    def unit(cls, name):
        return yaml.safe_load((cls.folder / f"{name}_unit.yaml").read_text())["actuator"]

    @staticmethod
    def parameters(unit, of_stddev=False):
        """Offsets and angles, or their standard deviations."""
        rows = [(joint, ["offset"]) for joint in unit["joints"]]
        rows += [(axis, ["polar", "azimuth"]) for axis in unit["poles"] + unit["coils"]]
        return np.array([(row["stddev"] if of_stddev else row)[key] for row, keys in rows for key in keys])

    def test_finds_the_truth(self):
        truth = yaml.safe_load((self.folder / "s.truth.yaml").read_text())["actuator"]
        found = self.unit("drawn")
        apart = (self.parameters(found) - self.parameters(truth) + np.pi) % (2.0 * np.pi) - np.pi
        standardized = np.abs(apart) / self.parameters(found, of_stddev=True)
        self.assertEqual(len(standardized), 3 + 2 * (4 + 6))
        self.assertLess(standardized.max(), 4.0)
        self.assertGreaterEqual(np.count_nonzero(standardized < 1.96), 19)
        self.assertIn("29 parameters, of which 0 stay open", self.planned)

    def test_calibrates_by_a_table_as_by_its_polynomial(self):
        by_curve, by_table = self.unit("drawn"), self.unit("tabled")
        apart = np.abs(self.parameters(by_table) - self.parameters(by_curve))
        self.assertLess((apart / self.parameters(by_curve, of_stddev=True)).max(), 0.1)

    def test_predicts_what_an_own_model_of_the_saved_description_does(self):
        np.savetxt(self.folder / "q.csv", POSES, delimiter=",", fmt="%.17g")
        np.savetxt(self.folder / "i.csv", CURRENTS, delimiter=",", fmt="%.17g")
        files = ("--joints", "q.csv", "--currents", "i.csv", "--output", "r.csv")
        self.run_program("predict", "--actuator", "drawn_unit.yaml", *files)
        predicted = np.loadtxt(self.folder / "r.csv", delimiter=",")
        unit = self.unit("drawn")
        for joints, currents, row in zip(POSES, CURRENTS, predicted):
            rotation = orientation(unit, joints)
            x, y, z, w = row[:4]
            half = np.arctan2(np.linalg.norm([x, y, z]), w)
            told = turned(np.array([x, y, z]) / np.sin(half), 2.0 * half)
            np.testing.assert_allclose(told, rotation, atol=1e-9)
            np.testing.assert_allclose(row[5:8], torque(unit, rotation, currents), atol=1e-9)


if __name__ == "__main__":
    unittest.main()
