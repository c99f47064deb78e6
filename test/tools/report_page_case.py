"""What the tests of the report's page share: the programs, and recordings that are calibrated with a report."""

import os
import subprocess

import yaml

PROGRAMS = os.environ["PROGRAMS"]  # folder of the built programs
SOURCE = os.environ["SOURCE"]  # folder of this package

TIMEOUT = 600.0  # [s] of a program, on however busy a computer

# What a page must not take for markup.
HOSTILE = "<script>alert('&')</script><img src=x>"


def program(name):
    return os.path.join(PROGRAMS, name)


def run(*command):
    """Runs a program to its end; returns its status and what it said."""
    return subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT, check=False)


def actuator_file(folder, coils, serial):
    """The shipped actuator with fewer coils, so that a session is short."""
    with open(os.path.join(SOURCE, "config", "pm_spherical_8x24.yaml"), encoding="utf-8") as file:
        description = yaml.safe_load(file)
    description["actuator"]["coils"] = description["actuator"]["coils"][:coils]
    description["actuator"]["serial"] = serial
    path = os.path.join(folder, "actuator.yaml")
    with open(path, "w", encoding="utf-8") as file:
        yaml.safe_dump(description, file)
    return path


def calibrated(folder, actuator, session=(), config="validation: {hold_out_every: 7}\n"):
    """Records an emulated session and calibrates it; returns the finished process and the folder of the report."""
    bag = os.path.join(folder, "session.bag")
    recorded = run(program("simulate_recording"), "--actuator", actuator, "--output", bag, "--force", *session)
    assert recorded.returncode == 0, recorded.stderr
    config_path = os.path.join(folder, "config.yaml")
    with open(config_path, "w", encoding="utf-8") as file:
        file.write(config)
    report = os.path.join(folder, "report")
    command = [program("calibrate_bag"), "--actuator", actuator, "--config", config_path, "--report", report]
    command += ["--output", os.path.join(folder, "calibrated.yaml"), "--force", bag]
    return run(*command), report


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()
