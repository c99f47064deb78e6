"""The columns of samples.csv, as export_session writes and import_csv reads them (doc/recordings.md)."""

# Factors of the units that a heading may name, to SI.
DEGREE = 0.017453292519943295
UNITS = {
    "rad": {"rad": 1.0, "mrad": 1e-3, "deg": DEGREE},
    "N.m": {"N.m": 1.0, "N·m": 1.0, "Nm": 1.0, "mN.m": 1e-3, "mNm": 1e-3, "N.mm": 1e-3, "Nmm": 1e-3},
    "N": {"N": 1.0, "mN": 1e-3},
    "m": {"m": 1.0, "mm": 1e-3, "cm": 1e-2},
    "A": {"A": 1.0, "mA": 1e-3},
    "s": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9},
    "ns": {"ns": 1},
    "": {"": 1.0},
}
JOINTS = ("joint_1", "joint_2", "joint_3")
QUATERNION = ("orientation_x", "orientation_y", "orientation_z", "orientation_w")
TORQUE = ("torque_x", "torque_y", "torque_z")
# Name and unit; the currents follow, current_1 [A] and so on.
SAMPLE_COLUMNS = (
    ("id", ""),
    ("date", ""),
    ("removal", ""),
    ("stamp", "ns"),
    ("validation", ""),
    *((joint, "rad") for joint in JOINTS),
    *((f"{joint}_stddev", "rad") for joint in JOINTS),
    *((component, "") for component in QUATERNION),
    ("orientation_stddev", "rad"),
    *((component, "N.m") for component in TORQUE),
    ("torque_stddev", "N.m"),
    ("duration", "s"),
    ("measurements", ""),
    ("dwell", "ns"),
    *((f"{joint}_shared_stddev", "rad") for joint in JOINTS),
    ("torque_shared_stddev", "N.m"),
)


def heading(name, unit):
    """ "joint_1 [rad]", or the name alone where there is no unit."""
    return f"{name} [{unit}]" if unit else name
