#!/usr/bin/python3
"""What a calibrated actuator does: use_calibration.py CALIBRATED.yaml q1 q2 q3

Prints where the rotor is at these joint readings [rad], currents that turn it about its x axis, and what torque they
make, each with its standard deviation.
"""

import sys

from spherical_actuator_calibration.calibrated_actuator import CalibratedActuator


def main(path, *words):
    joints = [float(word) for word in words]
    with CalibratedActuator(path) as actuator:
        if not actuator.has_uncertainty:
            print("No uncertainty is stated: nobody has calibrated this, and ± 0 is not known.")
        pose = actuator.orientation(joints)
        print("orientation", *(f"{q:.6f}" for q in pose.quaternion_xyzw), f"± {pose.stddev:.6f} rad")
        if actuator.coils:
            found = actuator.currents([0.05, 0.0, 0.0], joints)  # [N m], rotor frame
            for coil, (current, stddev) in enumerate(zip(found.currents, found.stddevs), 1):
                print(f"coil_{coil} {current:.6f} ± {stddev:.6f} A")
            made = actuator.torque(joints, found.currents)
            print("torque", *(f"{t:.5f}" for t in made.torque), f"± {made.stddev:.5f} N·m")


if __name__ == "__main__":
    if len(sys.argv) != 5:
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    try:
        main(*sys.argv[1:])
    except ValueError as wrong:
        print(f"use_calibration: {wrong}", file=sys.stderr)
        sys.exit(2)
