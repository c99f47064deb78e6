"""Folders of tables and recordings for the tests of import_csv and export_session."""

import contextlib
import io
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import types
import unittest
from unittest import mock

import rosbag
import yaml
from program_module import loaded

SOURCE = pathlib.Path(os.environ["SOURCE"])
CALIBRATE_BAG = os.path.join(os.environ["PROGRAMS"], "calibrate_bag")


def run(program, *arguments):
    return subprocess.run(
        [str(program), *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False
    )


def call(program, *arguments):
    """The same within this process, which is quicker."""
    module = loaded(program)
    out, errors = io.StringIO(), io.StringIO()
    with mock.patch.object(sys, "argv", [program, *map(str, arguments)]):
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(errors):
            status = module.main()
    return types.SimpleNamespace(returncode=status, stdout=out.getvalue(), stderr=errors.getvalue())


class Folder(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")
        return self.folder / name

    def description(self, coils):
        actuator = {
            "name": "positioner",
            "serial": "unit-7",
            "joints": [
                {"name": f"axis_{k}", "axis": [float(k == j) for j in range(3)], "offset": 0.0} for k in range(3)
            ],
            "poles": [{"polar": 0.0, "azimuth": 0.0, "polarity": 1}] if coils else [],
            "coils": [{"polar": 0.1, "azimuth": float(j)} for j in range(coils)],
            "workspace": {"tilt_limit": 0.6},
        }
        if coils:
            actuator["torque_curve"] = {
                "angle_unit": "deg",
                "coefficients": [0.0, 0.01],
                "blend_start": 2.0,
                "support": [28.0, 32.0],
            }
        return self.write("actuator.yaml", yaml.safe_dump({"actuator": actuator}))

    def import_csv(self, *arguments):
        output = self.folder / "out.bag"
        return call("import_csv", "--actuator", self.folder / "actuator.yaml", "--output", output, *arguments)

    def refused(self, part, *arguments):
        result = self.import_csv(*arguments)
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        self.assertIn(part, result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        self.assertEqual(list(self.folder.glob("out.bag*")), [])

    def messages(self, topic):
        with rosbag.Bag(str(self.folder / "out.bag")) as bag:
            return [message for _, message, _ in bag.read_messages([f"/actuator/{topic}"])]
