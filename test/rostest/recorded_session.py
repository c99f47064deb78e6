#!/usr/bin/python3
"""The recording of a session is calibrated again of its streams, with nothing beside it, to the parameters of live."""

import csv
import glob
import os
import subprocess
import sys

import rospy
import rostest
import yaml
from calibration_client import NAMESPACE, PACKAGE, program, wait_for
from emulated_lab import LabCase
from recorder_links import wait_until_connected, wait_until_received

TOLERANCE = 1e-9
COIL = 3
CURRENT = 1.5  # [A]
POSES = [
    [0.1, 0.2, 0.4],  # not where it rests at the start, before the recorder is connected
    [0.3, 0.0, 0.8],
    [-0.3, 0.1, 1.6],
    [0.0, 0.3, 2.4],
    [0.1, -0.3, -0.8],
    [-0.2, -0.2, -1.6],
]
STREAMS = ("joint_states", "measured_orientation", "measured_torque", "coil_currents", "samples")
SETUP = ("calibration_description", "calibration_config")


class RecordedSession(LabCase):
    @classmethod
    def setUpClass(cls):
        cls.make_lab(seed=6, record=True)
        # A configuration that is not the shipped one: the recording must tell it.
        path = os.path.join(cls.lab.config, "calibration.yaml")
        with open(path, encoding="utf-8") as file:
            config = yaml.safe_load(file)
        config["means"]["torque_stddev_floor"] = 2e-4
        with open(path, "w", encoding="utf-8") as file:
            yaml.safe_dump(config, file)
        cls.start_lab()
        wait_until_connected([f"{NAMESPACE}/{topic}" for topic in STREAMS + SETUP])

    def capture(self, duration, validation=False):
        def is_taken():
            return self.client.call("capture", duration=duration, validation=validation).success

        wait_for(is_taken, "a sample")

    def measure(self):
        for pose in POSES:
            self.lab.excite(0, 0.0)
            self.lab.move(pose)
            self.capture(0.6)
            # Torques are held out: their residuals tell whether they are the same.
            self.lab.excite(COIL, CURRENT)
            self.capture(0.3, validation=True)
        self.lab.excite(0, 0.0)

    def recorded(self):
        bags = glob.glob(os.path.join(self.lab.directory, "recordings", "*.bag"))
        self.assertEqual(len(bags), 1)
        return bags[0]

    def calibrate(self, bag, *options):
        """What calibrate_bag prints, and its report."""
        output = os.path.join(self.folder.name, "offline.yaml")
        report = os.path.join(self.folder.name, "report")
        command = [program("calibrate_bag"), "--output", output, "--report", report, "--force", *options]
        command += ["--cycles", "joint", bag]
        result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
        self.assertIn(result.returncode, (0, 1), result.stdout + result.stderr)
        with open(os.path.join(report, "report.yaml"), encoding="utf-8") as file:
            return result.stdout, yaml.safe_load(file)["calibration_report"]

    def test_recording_and_tables_give_the_parameters_of_live(self):
        self.measure()
        live = [self.client.call(service, coil=0).report for service in ("calibrate_joint", "validate")]
        self.assertTrue(live[0].success, live[0].message)
        wait_until_received([f"{NAMESPACE}/{topic}" for topic in STREAMS + SETUP])
        self.lab.stop()
        self.streams_give_the_same(live)
        self.streams_follow_another_configuration(live)
        self.tables_give_the_same(live)

    def streams_give_the_same(self, live):
        bag = self.recorded()
        text, report = self.calibrate(bag, "--from", "streams")
        self.assertIn("Description: as recorded, pm_spherical_8x24", text)
        self.assertIn("Configuration: as recorded", text)
        self.assertIn(f"{2 * len(POSES)} samples that were taken live are made again", text)
        self.check_report(live, report)

    def streams_follow_another_configuration(self, live):
        bag = self.recorded()
        other = os.path.join(self.folder.name, "other.yaml")
        with open(other, "w", encoding="utf-8") as file:
            file.write("means: {torque_stddev_floor: 0.01}\n")
        text, report = self.calibrate(bag, "--from", "streams", "--config", other)
        self.assertIn(f"Configuration: {other}", text)
        for found, expected in zip(report["validation"]["residuals"], live[1].residuals):
            if found["quantity"] == "torque":
                self.assertLess(abs(found["standardized"]), abs(expected.standardized))
        text, report = self.calibrate(bag, "--config", other)
        self.assertIn("means.torque_stddev_floor of the configuration has no effect", text)
        self.check_report(live, report)

    def tables_give_the_same(self, live):
        """Session database, CSV files, recording, calibration."""
        tables = os.path.join(self.folder.name, "tables")
        bag = os.path.join(self.folder.name, "imported.bag")
        subprocess.run(
            [program("export_session"), os.path.join(self.lab.directory, "session.db"), tables], check=True
        )
        with open(os.path.join(tables, "parameters.csv"), encoding="utf-8") as file:
            lines = list(csv.DictReader(file))
        estimates = {line["name"]: line for line in lines if line["cycle"] == "joint"}
        for estimate in live[0].estimates:
            self.assertEqual(float(estimates[estimate.name]["value"]), estimate.value)
            self.assertEqual(float(estimates[estimate.name]["stddev"]), estimate.stddev)
            self.assertEqual(estimates[estimate.name]["unit"], estimate.unit)
        actuator = os.path.join(tables, "actuator.yaml")
        command = [program("import_csv"), "--actuator", actuator, "--output", bag, os.path.join(tables, "samples.csv")]
        subprocess.run(command, check=True)
        self.check_report(live, self.calibrate(bag)[1])

    def check_report(self, live, report):
        joint, validation = live
        cycle = report["cycles"][0]
        self.assertEqual((joint.samples_used, cycle["samples_used"]), (len(POSES), len(POSES)))
        self.assertEqual(len(joint.estimates), len(cycle["estimates"]))
        for found, expected in zip(cycle["estimates"], joint.estimates):
            self.assertEqual(found["name"], expected.name)
            for key in ("value", "stddev"):
                self.assertAlmostEqual(found[key], getattr(expected, key), delta=TOLERANCE, msg=expected.name)
        self.check_residuals(cycle["residuals"], joint.residuals)
        self.check_residuals(report["validation"]["residuals"], validation.residuals)
        torques = [residual for residual in report["validation"]["residuals"] if residual["quantity"] == "torque"]
        self.assertEqual(len(torques), len(POSES))

    def check_residuals(self, found, expected):
        self.assertEqual([one["id"] for one in found], [one.id for one in expected])
        for one, other in zip(found, expected):
            self.assertAlmostEqual(one["residual"], other.residual, delta=TOLERANCE, msg=other)
            self.assertAlmostEqual(one["standardized"], other.standardized, delta=1e3 * TOLERANCE, msg=other)


if __name__ == "__main__":
    rospy.init_node("recorded_session_test")
    rostest.rosrun(PACKAGE, "recorded_session", RecordedSession, sys.argv)
