#!/usr/bin/python3
"""What programs do before they begin their work: nodes without a master, studies whose output has no folder."""

import os
import pathlib
import signal
import socket
import subprocess
import tempfile
import unittest

from hanging_master_test import NEVER, Master, environment

PROGRAMS = pathlib.Path(os.environ["PROGRAMS"])
ACTUATOR = pathlib.Path(os.environ["SOURCE"]) / "config/pm_spherical_8x24.yaml"
PATIENCE = 60.0  # [s]
NODES = ["coil_driver", "visualization"]
if (PROGRAMS / "calibration").exists():  # not without a session database
    NODES.append("calibration")
FOR_EVER = "1000000000"  # seeds or trials


class ProgramsStart(unittest.TestCase):
    @staticmethod
    def without_master():
        with socket.socket() as closed:
            closed.bind(("127.0.0.1", 0))
            return {**os.environ, "ROS_MASTER_URI": f"http://127.0.0.1:{closed.getsockname()[1]}"}

    def test_a_node_that_waits_for_its_master_obeys_signals(self):
        for name in NODES:
            for number in (signal.SIGTERM, signal.SIGINT):
                node = subprocess.Popen(
                    [PROGRAMS / name], env=self.without_master(), stdout=subprocess.PIPE, stderr=subprocess.STDOUT
                )
                with node:
                    self.assertIn(b"No ROS master answers", node.stdout.readline(), name)
                    node.send_signal(number)
                    self.assertEqual(node.wait(timeout=PATIENCE), 0, name)

    def test_a_value_in_the_place_of_a_name_is_told(self):
        command = [PROGRAMS / "publish_parameters", f"description:={ACTUATOR}"]
        answer = subprocess.run(
            command, env=self.without_master(), stderr=subprocess.PIPE, timeout=PATIENCE, text=True, check=False
        )
        self.assertEqual(answer.returncode, 1)
        self.assertIn("Parameters begin with an underscore: _parameter:=value.", answer.stderr)
        self.assertEqual(len(answer.stderr.splitlines()), 1)

    def test_a_parameter_that_was_misspelt_in_an_earlier_call_is_told(self):
        master = Master(NEVER)
        self.addCleanup(master.close)
        for parameter, key in (("descripton", None), ("description", "descripton")):
            answer = subprocess.run(
                [PROGRAMS / "publish_parameters", f"_{parameter}:={ACTUATOR}"],
                env=environment(master.uri),
                stderr=subprocess.PIPE,
                timeout=PATIENCE,
                text=True,
                check=False,
            )
            self.assertEqual(answer.returncode, 1)
            self.assertEqual("rosparam delete" in answer.stderr, key is not None, answer.stderr)
        self.assertIn("descripton: the key is unknown here", answer.stderr)
        self.assertIn("rosparam delete /publish_parameters/descripton", answer.stderr)

    def test_help_needs_no_master(self):
        for name in NODES:
            answer = subprocess.run(
                [PROGRAMS / name, "--help"], env=self.without_master(), stdout=subprocess.PIPE, timeout=PATIENCE
            )
            self.assertEqual(answer.returncode, 0, name)
            self.assertIn(b"Usage: " + name.encode(), answer.stdout)

    def test_nothing_is_calculated_for_a_file_that_cannot_be_written(self):
        with tempfile.TemporaryDirectory() as folder:
            output = ("--actuator", ACTUATOR, "--output", pathlib.Path(folder) / "missing/study.yaml")
            for study in (
                ("paper_study", "--truth", ACTUATOR, "--seeds", FOR_EVER),
                ("calibration_study", "--trials", FOR_EVER),
            ):
                answer = subprocess.run(
                    [PROGRAMS / study[0], *study[1:], *output], stderr=subprocess.PIPE, timeout=PATIENCE
                )
                self.assertEqual(answer.returncode, 2)
                self.assertIn(b"there is no folder", answer.stderr)


if __name__ == "__main__":
    unittest.main()
