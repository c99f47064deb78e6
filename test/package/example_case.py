"""What the examples must do, wherever they were built."""

import os
import re
import subprocess

POSITIONER = os.path.join("config", "examples", "two_axis_positioner")

# Of the real machine: value and standard deviation, as calibrate_bag finds them, beside a map of what they leave.
POSITIONER_PARAMETERS = {
    "joint_1/offset": (-0.001349, 0.000145),
    "joint_1/axis_u": (-0.002704, 0.000153),
    "joint_1/axis_v": (-0.010689, 0.000155),
    "joint_2/offset": (-0.000445, 0.000135),
    "joint_2/axis_u": (-0.004486, 0.000135),
    "joint_2/axis_v": (-0.003444, 0.000051),
    "joint_3/offset": (-0.004181, 0.000073),
}
LINE = re.compile(r"^(\S+) +(-?[\d.]+) ± ([\d.]+)( \(not identified\))?$", re.MULTILINE)


def run(*command, **options):
    """Runs a program to its end; returns its status and what it said."""
    return subprocess.run(command, capture_output=True, text=True, timeout=600, check=False, **options)


def check_calibrate_samples(case, program, source):
    """The example finds the parameters of the positioner, and tells which the measurements do not show."""
    folder = os.path.join(source, POSITIONER)
    result = run(program, os.path.join(folder, "actuator.yaml"), os.path.join(folder, "samples.yaml"))
    case.assertEqual(result.returncode, 1, result.stderr)
    # A map follows the samples: that little is left of them says nothing of their noise.
    case.assertNotIn("stated noise", result.stdout)
    lines = {name: (float(value), float(stddev), bool(open_)) for name, value, stddev, open_ in LINE.findall(result.stdout)}
    for name, (value, stddev) in POSITIONER_PARAMETERS.items():
        case.assertFalse(lines[name][2], name)
        case.assertAlmostEqual(lines[name][0], value, delta=1.5e-6, msg=name)
        case.assertAlmostEqual(lines[name][1], stddev, delta=1.5e-6, msg=name)
    case.assertEqual(
        sorted(name for name, line in lines.items() if line[2]), ["joint_3/axis_u", "joint_3/axis_v"]
    )


def check_use_calibration(case, command, source):
    """The example tells orientation, currents and torque of the machine as drawn, which is turned about z alone."""
    result = run(*command, os.path.join(source, "config", "pm_spherical_8x24.yaml"), "0", "0", "0.5")
    case.assertEqual(result.returncode, 0, result.stderr)
    said = {name: rest.split() for name, _, rest in (line.partition(" ") for line in result.stdout.splitlines())}
    numbers = [abs(float(word)) for word in said["orientation"] if word not in ("±", "rad")]
    case.assertEqual(numbers, [0.0, 0.0, 0.247404, 0.968912, 0.0])
    case.assertEqual(sum(name.startswith("coil_") for name in said), 24)
    case.assertEqual([abs(float(word)) for word in said["torque"][:3]], [0.05, 0.0, 0.0])
    return result.stdout
