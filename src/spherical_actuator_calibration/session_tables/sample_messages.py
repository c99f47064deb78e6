"""Messages of samples.csv."""

import math

import genpy
from geometry_msgs.msg import Quaternion, Vector3

from spherical_actuator_calibration.msg import CalibrationSample

from ..unit_quaternion import normalised
from .columns import JOINTS, QUATERNION, SAMPLE_COLUMNS, TORQUE
from .table import Table, named

LATEST = (1 << 32) * 10**9 - 1  # [ns] that a stamp holds
# Samples that were written down have no clock, and a recording needs one that grows.
SPACING = 10**9  # [ns]


def unit_quaternion(row, values, column):
    """Normalised x, y, z, w."""
    unit, norm = normalised(values)
    if unit is None:
        row.fail(f"the quaternion has norm {norm:.4g} instead of 1.", column)
    return unit


class SampleTable:
    """A file of samples, for an actuator with so many coils. Without joints it may lack their columns, and needs
    orientations."""

    def __init__(self, path, coils, has_joints=True):
        self._table = Table(path, separator=None)
        self._coils = coils
        self._has_joints = has_joints
        self._columns = {}
        units = dict(SAMPLE_COLUMNS)
        units.update({f"current_{coil}": "A" for coil in range(1, coils + 1)})
        for index, title in enumerate(self._table.titles):
            name = named(title)[0]
            if name not in units:
                self._table.fail(f'column {index + 1} ("{title}") is none of samples.csv; rename it or take it out.')
            if name in self._columns:
                self._table.fail(f'column {index + 1} ("{title}") is there twice.')
            self._columns[name] = (index, self._table.factor(index, units[name]))
        for name in JOINTS if has_joints else QUATERNION:
            self._table.column(name)

    def messages(self):
        """Samples in use; those that were removed are left out."""
        messages, known = [], {}
        for row in self._table.rows():
            if self._text(row, "removal"):
                continue
            messages.append(self._message(row, len(messages) + 1))
            self._require_new(row, messages[-1], known)
        if not messages:
            self._table.fail("there is no sample.")
        return messages

    def _require_new(self, row, message, known):
        """Who reads the recording takes samples of one id and stamp for one that was told twice."""
        line = known.setdefault((message.id, message.header.stamp.to_nsec()), row.line)
        if line != row.line:
            row.fail(
                f"id {message.id} and stamp are those of line {line}: of tables that are put together, number the ids on.",
                self._index("id"),
            )

    def _text(self, row, name):
        return row.text(self._columns[name][0]) if name in self._columns else ""

    def _number(self, row, name, fallback=None, smallest=-math.inf):
        if fallback is not None and not self._text(row, name):
            return fallback
        column, factor = self._columns[name]
        value = row.number(column, factor)
        if value < smallest:
            row.fail(f"{value:g} is less than {smallest:g}.", column)
        return value

    def _integer(self, row, name, fallback, largest):
        if not self._text(row, name):
            return fallback
        return row.integer(self._columns[name][0], 0, largest)

    def _group(self, row, names):
        """Numbers of columns that are all there, or all empty; nothing then."""
        missing = [name for name in names if not self._text(row, name)]
        if len(missing) == len(names):
            return None
        if missing:
            row.fail(f"{missing[0]} is empty, but others that belong to it are not.", self._index(missing[0]))
        return [self._number(row, name) for name in names]

    def _index(self, name):
        return self._columns[name][0] if name in self._columns else None

    def _stddev(self, row, name):
        return self._number(row, name, 0.0, 0.0)

    def _message(self, row, number):
        message = CalibrationSample()
        message.id = self._integer(row, "id", number, 2**32 - 1)
        message.header.stamp = genpy.Time(0, self._integer(row, "stamp", number * SPACING, LATEST))
        message.dwell = genpy.Time(0, self._integer(row, "dwell", 0, LATEST))
        message.validation = bool(self._integer(row, "validation", 0, 1))
        message.duration = self._number(row, "duration", 0.0, 0.0)
        message.measurements = self._integer(row, "measurements", 1, 2**32 - 1)
        for needed in JOINTS if self._has_joints else QUATERNION:
            if not self._text(row, needed):
                row.fail("it is empty.", self._index(needed))
        # Without joints calibrate_bag takes them from the orientation.
        message.joint_position = [self._number(row, joint, None if self._has_joints else 0.0) for joint in JOINTS]
        message.joint_stddev = [self._stddev(row, f"{joint}_stddev") for joint in JOINTS]
        message.joint_shared_stddev = [self._stddev(row, f"{joint}_shared_stddev") for joint in JOINTS]
        self._add_orientation(row, message)
        self._add_torque(row, message)
        return message

    def _add_orientation(self, row, message):
        values = self._group(row, QUATERNION)
        message.has_orientation = values is not None
        message.orientation.w = 1.0
        if values:
            message.orientation = Quaternion(*unit_quaternion(row, values, self._index(QUATERNION[0])))
            message.orientation_stddev = self._stddev(row, "orientation_stddev")

    def _add_torque(self, row, message):
        currents = self._group(row, [f"current_{coil}" for coil in range(1, self._coils + 1)])
        message.current = currents or []
        values = self._group(row, TORQUE)
        message.has_torque = values is not None
        if values is None:
            return
        if currents is None:
            row.fail(f"a torque needs the currents of all {self._coils} coils, current_1 and so on.")
        message.torque = Vector3(*values)
        message.torque_stddev = self._stddev(row, "torque_stddev")
        message.torque_shared_stddev = self._stddev(row, "torque_shared_stddev")
