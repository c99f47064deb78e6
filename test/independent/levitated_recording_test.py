#!/usr/bin/python3
"""A recording of a rotor without joints, drawn by the laboratory of levitated.py: orientations, torques and currents, no
joint_states. What calibrate_bag, predict, actuator_model and plan_session make of it."""

import os
import pathlib
import subprocess
import tempfile
import unittest

import laboratory
import levitated
import numpy as np
import recorded_dwells
import yaml
from recorded_dwells import EXCITED, MOVE, WITHOUT_CURRENT

PROGRAMS = pathlib.Path(os.environ["PROGRAMS"])
SPHERE = pathlib.Path(os.environ["SOURCE"]) / "config" / "reaction_sphere.yaml"
EXACT = {"registration": {name: {"stddev": 0.0} for name in ("stator_tracker", "rotor_marker", "rotor_ft_sensor")}}
POSES, COILS_PER_POSE, AMPERE = 28, 6, 2.0


def run(name, *arguments, status=0, stdin=None):
    result = subprocess.run(
        [PROGRAMS / name, *map(str, arguments)], capture_output=True, text=True, check=False, input=stdin
    )
    if result.returncode != status:
        raise RuntimeError(f"{name}: {result.returncode}\n{result.stdout}\n{result.stderr}")
    return result.stdout + result.stderr


class Recorder(recorded_dwells.Recorder):
    """Without joints: the tracker sees every motion."""

    def move(self, before, after):
        """From one orientation to another; the torque and the currents are zero."""
        steps = round(MOVE * self.streams.orientation_rate)
        turn = laboratory.rotation_vector(after @ before.T)
        begin = self.time
        for step in range(steps):
            self.orientations(laboratory.rotation(turn * step / steps) @ before, 1.0 / self.streams.orientation_rate)
            self.time += 1.0 / self.streams.orientation_rate
        self.time = begin
        self.torques(np.zeros(3), MOVE)
        self.currents({}, MOVE)
        self.time += MOVE

    def rest(self, R, torques):
        for current, torque in [({}, np.zeros(3)), *torques]:
            duration = EXCITED if current else WITHOUT_CURRENT
            self.orientations(R, duration)
            self.torques(torque, duration)
            self.currents(current, duration)
            self.time += duration


class LevitatedRecording(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls._folder = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls._folder.name)
        cls.unit, rng = levitated.reaction_sphere(), np.random.default_rng(8)
        cls.errors = rng.uniform(-0.02, 0.02, cls.unit.size())
        (cls.folder / "config.yaml").write_text(yaml.safe_dump({**EXACT, "validation": {"hold_out_every": 8}}))
        orientations = levitated.random_orientations(POSES, 0.5, rng)
        coils = levitated.chosen_coils(cls.unit, orientations, COILS_PER_POSE, rng).reshape(POSES, COILS_PER_POSE)
        recorder = Recorder(str(cls.folder / "session.bag"), cls.unit, recorded_dwells.Streams(), rng)
        before = np.eye(3)
        for R, chosen in zip(orientations, coils):
            torques = AMPERE * cls.unit.torques(cls.errors, np.repeat(R[None], len(chosen), axis=0), chosen)
            recorder.move(before, R)
            recorder.rest(R, [({int(coil): AMPERE}, torque) for coil, torque in zip(chosen, torques)])
            before = R
        recorder.close()
        cls.said = run(
            *("calibrate_bag", "--actuator", SPHERE, "--config", cls.folder / "config.yaml"),
            *("--output", cls.folder / "calibrated.yaml", "--report", cls.folder / "report"),
            *("--urdf", cls.folder / "sphere.urdf", "--covariance", cls.folder / "covariance.yaml"),
            *("--certificate", cls.folder / "certificate.xml", cls.folder / "session.bag"),
        )
        cls.calibrated = yaml.safe_load((cls.folder / "calibrated.yaml").read_text())["actuator"]

    @classmethod
    def tearDownClass(cls):
        cls._folder.cleanup()

    def angles(self):
        axes = self.calibrated["poles"] + self.calibrated["coils"]
        values = np.array([[axis["polar"], axis["azimuth"]] for axis in axes])
        stddevs = np.array([[axis["stddev"]["polar"], axis["stddev"]["azimuth"]] for axis in axes])
        return values.ravel(), stddevs.ravel()

    def test_the_unit_is_found_within_the_stated_uncertainty(self):
        self.assertIn("grade: good", self.said)
        values, stddevs = self.angles()
        apart = np.remainder(values - self.unit.values(self.errors) + np.pi, 2.0 * np.pi) - np.pi
        self.assertLess(np.abs(apart / stddevs).max(), 4.0)
        self.assertAlmostEqual(np.sqrt(np.mean((apart / stddevs) ** 2)), 1.0, delta=0.3)
        self.assertLess(np.median(stddevs), 3e-4)

    def test_nothing_of_joints_is_told(self):
        self.assertEqual(self.calibrated["joints"], [])
        report = yaml.safe_load((self.folder / "report" / "report.yaml").read_text())["calibration_report"]
        self.assertNotIn("joint_axes", report)
        self.assertEqual(report["coverage"]["joints"], [])
        self.assertEqual({row["kind"] for row in report["parameters"]}, {"pole", "coil"})
        self.assertTrue((self.folder / "report" / "report.html").stat().st_size > 10000)
        covariance = (self.folder / "covariance.yaml").read_text()
        for text in (self.said, covariance, (self.folder / "calibrated.yaml").read_text()):
            self.assertNotIn("joint_1", text)
        self.assertNotIn("joint", (self.folder / "certificate.xml").read_text())
        self.assertIn('type="floating"', (self.folder / "sphere.urdf").read_text())

    def test_predicted_torques_are_those_of_the_identified_axes(self):
        rng = np.random.default_rng(3)
        R = levitated.random_orientations(5, 0.6, rng)
        coils = rng.integers(0, 20, 5)
        currents = AMPERE * (np.arange(20)[None, :] == coils[:, None])
        quaternions = np.array([laboratory.quaternion_xyzw(one) for one in R])
        np.savetxt(self.folder / "q.csv", quaternions, delimiter=",", fmt="%.17g")
        np.savetxt(self.folder / "i.csv", currents, delimiter=",", fmt="%.17g")
        run(
            *("predict", "--actuator", self.folder / "calibrated.yaml", "--orientations", self.folder / "q.csv"),
            *("--currents", self.folder / "i.csv", "--output", self.folder / "r.csv", "--force"),
        )
        told = np.loadtxt(self.folder / "r.csv", delimiter=",")
        identified = self.angles()[0] - self.unit.values(np.zeros(self.unit.size()))
        expected = AMPERE * self.unit.torques(identified, R, coils)
        np.testing.assert_allclose(told[:, :3], expected, atol=1e-12)
        self.assertTrue(np.all(told[:, 3] > 0.0))
        question = " ".join(map(repr, [*quaternions[0].tolist(), *currents[0].tolist()]))
        answers = run(
            "actuator_model", "--actuator", self.folder / "calibrated.yaml",
            stdin=f"torque {question}\norientation 0 0 0\n",
        ).splitlines()
        np.testing.assert_allclose(np.array(answers[1].split(), float), told[0], atol=1e-12)
        self.assertEqual(answers[2], "error: The rotor has no joints: the tracker alone tells its orientation.")

    def test_a_table_without_joints_is_imported(self):
        rng, laboratory_ = np.random.default_rng(4), levitated.Laboratory()
        orientations = levitated.random_orientations(20, 0.5, rng)
        coils = levitated.chosen_coils(self.unit, orientations, 8, rng)
        session = levitated.measured_session(self.unit, self.errors, laboratory_, orientations, coils, rng)
        heads = [f"orientation_{c}" for c in "xyzw"] + ["orientation_stddev [rad]"]
        heads += [f"torque_{c} [N.m]" for c in "xyz"] + ["torque_stddev [N.m]"]
        heads += [f"current_{coil} [A]" for coil in range(1, 21)]
        lines = [",".join(heads)]
        for dwell, coil, torque in zip(session.dwell, session.coils, session.torques):
            values = [*laboratory.quaternion_xyzw(session.orientations[dwell]), laboratory_.orientation]
            values += [*torque, laboratory_.torque, *(AMPERE * (np.arange(20) == coil))]
            lines.append(",".join(repr(float(value)) for value in values))
        table, bag, output = (self.folder / name for name in ("table.csv", "table.bag", "table.yaml"))
        table.write_text("\n".join(lines) + "\n")
        run("import_csv", "--actuator", SPHERE, "--output", bag, table)
        run("calibrate_bag", "--actuator", SPHERE, "--output", output, bag)
        written = self.folder / "written.yaml"
        levitated.write_samples(written, self.unit, laboratory_, session)
        run("samples_to_bag", "--actuator", SPHERE, "--samples", written, "--output", self.folder / "written.bag")
        run("calibrate_bag", "--actuator", SPHERE, "--output", self.folder / "same.yaml", self.folder / "written.bag")
        both = [yaml.safe_load(path.read_text())["actuator"]["coils"] for path in (output, self.folder / "same.yaml")]
        for one, other in zip(*both):
            self.assertAlmostEqual(one["polar"], other["polar"], delta=1e-9)
            self.assertAlmostEqual(one["stddev"]["polar"], other["stddev"]["polar"], delta=1e-9)

    def test_what_does_not_fit_is_refused(self):
        (self.folder / "one.csv").write_text("0,0,0\n")
        (self.folder / "unit.csv").write_text("0,0,0,1\n")
        for options, reason in (
            (("--joints", self.folder / "one.csv"), "the rotor has no joints; give its orientations"),
            (("--orientations", self.folder / "unit.csv"), "only the torque can be predicted"),
            ((), "Give one of --joints and --orientations."),
        ):
            said = run(
                *("predict", "--actuator", SPHERE, "--output", self.folder / "no.csv"), *options, status=2
            )
            self.assertIn(reason, said)
        said = run(
            *("calibrate_bag", "--actuator", SPHERE, "--cycles", "joint,refine", "--output", self.folder / "no.yaml"),
            self.folder / "session.bag", status=0,
        )
        self.assertIn("The description has no joints", said)

    def test_a_session_is_planned_simulated_and_calibrated(self):
        plan = self.folder / "plan.yaml"
        said = run(
            *("plan_session", "--actuator", SPHERE, "--poses", 12, "--torques-per-pose", 6, "--output", plan),
            *("--orientation-stddev", 1e-4, "--candidates", 60),
        )
        # The tracker's error of each pose counts in the plan and in the bound.
        self.assertIn("of as many poses and torques could reach", said)
        self.assertNotIn("makes no error", said)
        bag, truth = self.folder / "simulated.bag", self.folder / "truth.yaml"
        run("simulate_recording", "--actuator", SPHERE, "--plan", plan, "--output", bag, "--truth-out", truth)
        said = run(
            *("calibrate_bag", "--actuator", SPHERE, "--truth", truth, "--output", self.folder / "simulated.yaml", bag),
        )
        self.assertIn("of 56 identified parameters", said)
        self.assertNotIn("joint_states", said)


if __name__ == "__main__":
    unittest.main()
