"""Runs the package on recordings of motion, by its program motion_cases.

Environment: MOTION_CASES, the program (build/test/motion_cases of the project).
"""

import os
import pathlib
import subprocess
import tempfile

import free_motion
import numpy as np

PROJECT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("MOTION_CASES", str(PROJECT / "build" / "test" / "motion_cases"))
NOMINAL = str(PROJECT / "config" / "pm_spherical_8x24.yaml")
KINDS = ("turn", "scale", "curve", "tracker drift", "current clock", "tracker clock")  # of errors that the model lacks


class Outcome:
    """What motion_cases prints of one file."""

    def __init__(self, lines):
        self.parameters, self.left_out, self.response, self.unmodelled = {}, {}, None, {}
        rows = []
        for line in lines:
            word, *rest = line.split()
            if word == "parameter":
                name, value, stddev, state = rest
                self.parameters[name] = float(value), float(stddev), state == "identified"
            elif word == "covariance":
                rows.append([float(value) for value in rest])
            elif word == "left_out":
                self.left_out[" ".join(rest[1:])] = int(rest[0])
            elif word == "response":
                self.response = [float(value) for value in rest]  # delay, lag, what is left of a delay
            elif word == "tracker":
                self.tracker_colour = float(rest[1])  # of the variance of means
            elif word == "alignment":
                self.alignment, self.alignment_limit = float(rest[0]), float(rest[2])
            elif word == "unmodelled":
                values = np.array([float(value) for value in rest[10:]]).reshape(-1, 2)  # and their stddevs
                self.unmodelled[KINDS[int(rest[0])], int(rest[1])] = float(rest[3]), values
            elif word == "skew":
                self.skew = [float(value) for value in rest[:4]]  # joint 2 and its stddev, joint 3 and its
            elif word == "live":
                self.live = {"windows": int(rest[0])}
                self.live.update({rest[n]: float(rest[n + 1]) for n in (1, 3, 5, 7)})
                self.live["ratios"] = float(rest[10]), float(rest[11])
            elif word == "held_out":
                self.held_out, self.probability = int(rest[0]), float(rest[rest.index("probability") + 1])
            elif word == "motion":
                self.moves, self.converged = rest[0] == "moves", rest[2] == "0"
                self.chi_square = float(rest[rest.index("chi_square") + 1])

        self.covariance = np.array(rows)  # of all parameters in their order

    def value(self, name):
        return self.parameters[name][0]

    def judged(self, unit, errors):
        """Errors and standard deviations of the unit's own parameters; which are identified."""
        rows = [self.parameters[name] for name in unit.names()]
        apart = np.array([row[0] for row in rows]) - unit.values(errors)
        apart = (apart + np.pi) % (2.0 * np.pi) - np.pi
        return apart, np.array([row[1] for row in rows]), np.array([row[2] for row in rows])

    def distance(self, unit, errors):
        """Squared error of all the unit's parameters together by their covariance, over their number: 1 in the mean."""
        apart, _, _ = self.judged(unit, errors)
        names = list(self.parameters)
        places = [names.index(name) for name in unit.names()]
        return apart @ np.linalg.solve(self.covariance[np.ix_(places, places)], apart) / len(apart)


def calibrate(recording, nominal=NOMINAL, options=()):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "streams.txt")
        free_motion.write_text(path, recording)
        command = [PROGRAM, nominal, *options, path]
        return Outcome(subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout.splitlines())
