"""One motion of a free rotor that the package did not simulate, recorded in several ways and calibrated by its programs.

Environment: PROGRAMS, the folder of the programs.
"""

import os
import subprocess
import unittest

import free_motion
import laboratory
import numpy as np
import yaml
from motion_cases import NOMINAL


def run(program, *arguments):
    command = [os.path.join(os.environ["PROGRAMS"], program), *arguments]
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)


def read_yaml(path):
    with open(path, encoding="utf-8") as file:
        return yaml.safe_load(file)


def write_yaml(path, content):
    with open(path, "w", encoding="utf-8") as file:
        yaml.safe_dump(content, file, default_flow_style=None)


class RecordedMotion(unittest.TestCase):
    SECONDS = 12.0  # of the motion
    SEED = 5
    MACHINE = free_motion.Machine(push=(6.0, 6.2, (0.0, 0.0, 4e-3)))

    @classmethod
    def setUpClass(cls):
        cls.unit = laboratory.paper_unit()
        rng = np.random.default_rng(cls.SEED)
        cls.errors = rng.uniform(-0.03, 0.03, cls.unit.size())
        cls.motion = free_motion.simulate(cls.unit, cls.errors, cls.MACHINE, cls.SECONDS, cls.SEED)

    def record(self, **streams):
        return free_motion.record(self.unit, self.errors, self.motion, free_motion.Streams(**streams), self.SEED)

    @staticmethod
    def calibrate_bags(folder, cycles, bags, *options, actuator=NOMINAL):
        output = os.path.join(folder, cycles + ".yaml")
        return run("calibrate_bag", "--actuator", actuator, "--cycles", cycles, "--output", output, *options, *bags)
