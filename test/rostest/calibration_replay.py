#!/usr/bin/python3
"""A recording that is played into the node gives the parameters that calibrate_bag finds in it."""

import os
import sys
import tempfile
import unittest

import rospy
import rostest
import yaml
from calibration_client import (
    NAMESPACE,
    PACKAGE,
    CalibrationClient,
    CalibrationNode,
    play,
    run_tool,
    stop_player,
    wait_for,
)

TOLERANCE = 1e-9
MAIN_COIL = 1
# The computer is busy with something else whenever so many samples are held, for so long.
STALLS = (5, 15, 30)
STALL_DURATION = 0.7  # [s]
# Seed and numbers give a recording of 80 s that determines every parameter.
SESSION = {
    "seed": 2,
    "joint-poses": 4,
    "main-coil": MAIN_COIL,
    "main-coil-poses": 12,
    "coil-poses": 2,
    "coils-per-dwell": 8,
    "validation-poses": 1,
    "joint-rate": 100,
    "tracker-rate": 50,
    "wrench-rate": 100,
    "current-rate": 100,
}


def load(path):
    with open(path, encoding="utf-8") as file:
        return yaml.safe_load(file)


class Replay(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.bag = cls.path("session.bag")
        cls.description = cls.path("actuator.yaml")
        with open(cls.description, "w", encoding="utf-8") as file:
            yaml.safe_dump({"actuator": rospy.get_param(NAMESPACE + "/actuator")}, file)
        run_tool("simulate_recording", actuator=cls.description, output=cls.bag, **SESSION)
        run_tool(
            "calibrate_bag",
            actuator=cls.description,
            output=cls.path("expected.yaml"),
            report=cls.path("report"),
            cycles=f"joint,poles:{MAIN_COIL},coils,refine",
            bags=[cls.bag],
        )
        cls.expected = load(cls.path("expected.yaml"))["actuator"]
        cls.cycles = load(cls.path("report/report.yaml"))["calibration_report"]["cycles"]

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder.name, name)

    def setUp(self):
        self.client = CalibrationClient()
        self.node = CalibrationNode(self.path("calibration"), auto_capture=True)
        self.addCleanup(self.node.stop)
        self.client.start(self.node)

    def test_parameters_equal_those_of_calibrate_bag(self):
        player = play(self.bag, "--clock", "--rate", str(rospy.get_param("~rate")))
        self.addCleanup(stop_player, player)
        for samples in STALLS:
            self.wait_for_samples(samples)
            self.node.stall(STALL_DURATION)
        joint = self.cycles[0]
        expected = joint["samples_used"] + joint["samples_rejected"]
        self.wait_for_samples(expected)
        self.assertEqual(len(self.client.held()), expected)
        for cycle in self.cycles:
            self.check_cycle(cycle, self.calibrate(cycle))
        self.check_parameters()
        self.check_saved_file()

    def wait_for_samples(self, count):
        def are_there():
            return self.client.latest("status").orientation_samples >= count

        wait_for(are_there, f"{count} samples")

    def calibrate(self, cycle):
        service = {"refine": "refine"}.get(cycle["cycle"], "calibrate_" + cycle["cycle"])
        answer = self.client.call(service, coil=cycle["coil"])
        self.assertTrue(answer.success, answer.message)
        return answer.report

    def check_cycle(self, cycle, report):
        what = f"{cycle['cycle']}:{cycle['coil']}"
        self.assertEqual(report.samples_used, cycle["samples_used"], what)
        self.assertEqual(report.samples_rejected, cycle["samples_rejected"], what)
        estimates = {estimate.name: estimate for estimate in report.estimates}
        self.assertEqual(len(estimates), len(cycle["estimates"]), what)
        for expected in cycle["estimates"]:
            estimate = estimates[expected["name"]]
            for key in ("value", "stddev"):
                self.assert_close(getattr(estimate, key), expected[key], f"{what} {estimate.name}")

    def check_parameters(self):
        def has_last():
            return self.client.revision() == len(self.cycles)

        wait_for(has_last, "parameters of the last cycle")
        parameters = self.client.latest("parameters")
        self.assertEqual(parameters.source, "identified")
        for joint, expected in zip(parameters.joints, self.expected["joints"]):
            self.assert_close(joint.offset, expected["offset"], expected["name"])
            axis = [joint.axis.x, joint.axis.y, joint.axis.z]
            for component, wanted in zip(axis, expected["axis"]):
                self.assert_close(component, wanted, expected["name"])
        for group in ("poles", "coils"):
            found = getattr(parameters, group)
            self.assertEqual(len(found), len(self.expected[group]))
            for k, (axis, expected) in enumerate(zip(found, self.expected[group]), start=1):
                for key in ("polar", "azimuth"):
                    self.assert_close(getattr(axis, key), expected[key], f"{group} {k} {key}")

    def check_saved_file(self):
        answer = self.client.call("save")
        self.assertTrue(answer.success, answer.message)
        files = [name for name in os.listdir(self.node.directory) if name.endswith(".yaml")]
        self.assertEqual(len(files), 1, files)
        saved = load(os.path.join(self.node.directory, files[0]))["actuator"]
        record = saved.pop("calibration")
        self.assertEqual(record["revision"], len(self.cycles))
        self.check_report(answer.message, record["revision"])
        expected = dict(self.expected)
        expected_record = expected.pop("calibration")
        self.assert_same(saved, expected, files[0])
        self.assert_same(record["cycles"], expected_record["cycles"], "cycles")

    def check_report(self, message, revision):
        folder = os.path.join(self.node.directory, f"report_revision_{revision}")
        self.assertIn(f"Report: {folder}/report.html.", message)
        self.assertEqual(sorted(os.listdir(folder)), ["report.html", "report.yaml"])
        report = load(os.path.join(folder, "report.yaml"))["calibration_report"]
        self.assertEqual(report["revision"], revision)
        self.assertEqual([cycle["cycle"] for cycle in report["cycles"]], [cycle["cycle"] for cycle in self.cycles])

    def assert_same(self, found, expected, where):
        """Two parts of a YAML file are the same but for rounding."""
        self.assertEqual(type(found), type(expected), where)
        if isinstance(expected, dict):
            self.assertEqual(sorted(found), sorted(expected), where)
            for key, value in expected.items():
                self.assert_same(found[key], value, f"{where} {key}")
        elif isinstance(expected, list):
            self.assertEqual(len(found), len(expected), where)
            for k, value in enumerate(expected):
                self.assert_same(found[k], value, f"{where}[{k}]")
        elif isinstance(expected, float):
            self.assert_close(found, expected, where)
        else:
            self.assertEqual(found, expected, where)

    def assert_close(self, found, expected, where):
        self.assertAlmostEqual(float(found), float(expected), delta=TOLERANCE, msg=where)


if __name__ == "__main__":
    rospy.init_node("calibration_replay")
    rostest.rosrun(PACKAGE, "calibration_replay", Replay, sys.argv)
