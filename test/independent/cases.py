"""Runs the package on sessions of the independent laboratory, and reads what it says."""

import dataclasses
import os
import subprocess
import tempfile

import laboratory
import numpy as np

PROGRAM = os.environ.get("CALIBRATE_CASES", "build/test/calibrate_cases")
SOURCE = os.environ.get("SOURCE", os.path.join(os.path.dirname(__file__), "..", ".."))
ACTUATOR = os.path.join(SOURCE, "config", "pm_spherical_8x24.yaml")


@dataclasses.dataclass
class Outcome:
    values: np.ndarray
    stddevs: np.ndarray
    identified: np.ndarray
    grade: str
    reason: str
    cycles: list  # (name, success, message)
    seconds: float  # of the last cycle
    complete: bool  # exit status 0 of calibrate_bag
    joint_covariance: np.ndarray  # of the coordinates of the joints, 9x9 where there are any
    diagnoses: list  # (cause, message), where the last cycle was refused
    check: tuple  # (whether the held-out samples find it valid, message), where any are held out

    def refined(self):
        return self.cycles and self.cycles[-1][0] == "refine" and self.cycles[-1][1]


def registration_config(registration, more=""):
    """Configuration that states registrations; None: states none of them."""
    if registration is None:
        return more or "validation: {hold_out_every: 0}\n"
    names = ("stator_tracker", "rotor_marker", "rotor_ft_sensor")
    lines = [f"  {name}: {{stddev: {float(stddev)!r}}}" for name, stddev in zip(names, registration)]
    return "registration:\n" + "\n".join(lines) + "\n" + more


def read_outcomes(text, names):
    outcomes, rows, cycles, seconds, complete, covariance = [], {}, [], 0.0, False, None
    for line in text.splitlines():
        word, _, rest = line.partition(" ")
        if word == "case":
            rows, cycles, diagnoses, check = {}, [], [], None
        elif word == "cycle":
            name, how, _, _, _, _, _, taken, message = rest.split(" ", 8)
            cycles.append((name, how == "success", message))
            seconds = float(taken)
        elif word == "diagnosis":
            diagnoses.append(tuple(rest.split(" ", 1)))
        elif word == "check":
            how, _, message = rest.partition(" ")
            check = how == "valid", message
        elif word == "parameter":
            name, value, stddev, identified = rest.split(" ")
            rows[name] = (float(value), float(stddev), identified == "identified")
        elif word == "complete":
            complete = rest == "yes"
        elif word == "covariance":
            numbers = np.array(rest.split(), float)
            covariance = numbers.reshape(2 * [round(np.sqrt(numbers.size))])
        elif word == "grade":
            grade, _, reason = rest.partition(" ")
            chosen = [rows[name] for name in names]
            values, stddevs, identified = (np.array(column) for column in zip(*chosen))
            outcomes.append(
                Outcome(values, stddevs, identified, grade, reason, cycles, seconds, complete, covariance, diagnoses, check)
            )
    return outcomes


def calibrate(unit, sessions, config, actuator=ACTUATOR):
    """sessions: (laboratory, dwells, held out every so manieth) each. Returns an Outcome for each."""

    def write(path, session):
        laboratory.write_samples(path, unit, *session)

    return calibrate_written(unit.names(), sessions, write, config, actuator)


def calibrate_written(names, sessions, write, config, actuator):
    """write(path, session) writes the samples of one."""
    with tempfile.TemporaryDirectory() as folder:
        config_path = os.path.join(folder, "config.yaml")
        with open(config_path, "w", encoding="utf-8") as file:
            file.write(config)
        paths = []
        for n, session in enumerate(sessions):
            paths.append(os.path.join(folder, f"samples_{n}.yaml"))
            write(paths[-1], session)
        answer = subprocess.run([PROGRAM, actuator, config_path, *paths], capture_output=True, text=True, check=False)
        if answer.returncode != 0:
            raise RuntimeError(answer.stderr)
        return read_outcomes(answer.stdout, names)
