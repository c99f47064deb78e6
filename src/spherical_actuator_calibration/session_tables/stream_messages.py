"""Messages of the streams of other people's CSV files, as a YAML file describes them (doc/recordings.md)."""

import decimal
import math
import os

import genpy
from geometry_msgs.msg import Quaternion, QuaternionStamped, Vector3, Vector3Stamped
from sensor_msgs.msg import JointState

from spherical_actuator_calibration.msg import CoilCurrents

from ..text_files import excerpt
from ..unit_quaternion import normalised
from .columns import UNITS
from .sample_messages import LATEST, unit_quaternion
from .table import Table, TableError, named, parsed

IDENTITY = [0.0, 0.0, 0.0, 1.0]
KEYS = {"file", "stream", "headings", "separator", "decimal", "time", "values", "unit"}
FURTHER_KEYS = {
    "joint_states": set(),
    "measured_orientation": {"stator_tracker", "rotor_marker"},
    "measured_torque": {"force", "force_unit", "rotor_ft_sensor"},
    "coil_currents": set(),
}
UNIT_OF = {"joint_states": "rad", "measured_orientation": "", "measured_torque": "N.m", "coil_currents": "A"}


def product(a, b):
    """Of two quaternions x, y, z, w."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return [
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    ]


def inverse(q):
    return [-q[0], -q[1], -q[2], q[3]]


def rotated(q, v):
    return product(product(q, [*v, 0.0]), inverse(q))[:3]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


class Stream:
    """One file of a stream."""

    def __init__(self, entry, where, folder, actuator):
        self._entry = entry
        self._where = where
        self._actuator = actuator
        self.topic = self._get("stream", str)
        if self.topic not in FURTHER_KEYS:
            self._fail("stream", f'"{self.topic}" is none of {", ".join(FURTHER_KEYS)}.')
        unknown = set(entry) - KEYS - FURTHER_KEYS[self.topic]
        if unknown:
            self._fail(sorted(map(str, unknown))[0], f"a stream {self.topic} has no such key.")
        self.path = os.path.join(folder, self._get("file", str))
        self._table = Table(self.path, self._get("headings", int, 1), self._separator(), self._decimal())
        self._time, self._time_factor, self._offset = self._time_column()
        self._columns, self._factors = self._value_columns("values", self._width(), UNIT_OF[self.topic], "unit")
        self.left_out = 0
        self._largest_untold = 0.0  # angle of a column that names no unit [rad, as it is taken]

    def _fail(self, key, sentence):
        raise TableError(f"{self._where}.{key}: {sentence}")

    def _get(self, key, kind, fallback=None):
        value = self._entry.get(key, fallback)
        if not isinstance(value, kind) or isinstance(value, bool):
            self._fail(key, "it is needed, as " + {str: "a text", int: "a whole number", list: "a list", dict: "a map"}[kind] + ".")
        return value

    def _separator(self):
        separator = self._get("separator", str, ",")
        if len(separator) != 1:
            self._fail("separator", "it is one character.")
        return separator

    def _decimal(self):
        decimal_mark = self._get("decimal", str, ".")
        if decimal_mark not in (".", ","):
            self._fail("decimal", "it is a point or a comma.")
        return decimal_mark

    def _width(self):
        return {"joint_states": 3, "measured_orientation": 4, "measured_torque": 3}.get(
            self.topic, len(self._actuator.get("coils", []))
        )

    def _time_column(self):
        time = self._get("time", dict)
        unknown = set(time) - {"column", "unit", "offset"}
        if unknown or "column" not in time:
            self._fail("time", "it has the keys column, unit (s, ms, us or ns) and offset [s].")
        unit = time.get("unit", "s")
        if not isinstance(unit, str) or unit not in UNITS["s"]:
            self._fail("time.unit", f"it is one of {', '.join(UNITS['s'])}.")
        ticks = {"s": 10**9, "ms": 10**6, "us": 10**3, "ns": 1}[unit]
        offset = time.get("offset", 0)
        if not isinstance(offset, (int, float)) or isinstance(offset, bool) or not abs(offset) <= 2**32:
            self._fail("time.offset", "it is a number of seconds.")
        return self._table.column(self._name(time["column"], "time.column")), ticks, decimal.Decimal(str(offset)) * 10**9

    def _name(self, which, key):
        if not isinstance(which, (str, int)) or isinstance(which, bool):
            self._fail(key, "a column is told by its heading, or by its number from 1.")
        return which

    def _value_columns(self, key, width, unit, unit_key):
        names = self._get(key, list)
        if len(names) != width:
            self._fail(key, f"{len(names)} columns; {width} are needed.")
        columns = [self._table.column(self._name(name, key)) for name in names]
        # Coils in series are on one lead.
        if self.topic != "coil_currents" and len(set(columns)) < width:
            self._fail(key, "one column is there twice.")
        told = self._entry.get(unit_key)
        if told is not None:
            if not isinstance(told, str) or told not in UNITS[unit]:
                self._fail(unit_key, f"it is one of {', '.join(UNITS[unit])}.")
            return columns, [UNITS[unit][told]] * width
        return columns, [self._table.factor(column, unit) for column in columns]

    def _numbers(self, key, count, fallback=None):
        values = self._get(key, list, fallback)
        are_numbers = all(isinstance(v, (int, float)) and not isinstance(v, bool) and math.isfinite(v) for v in values)
        if len(values) != count or not are_numbers:
            self._fail(key, f"it is a list of {count} finite numbers.")
        return [float(value) for value in values]

    def _rotation(self, values, key):
        unit, norm = normalised(values)
        if unit is None:
            self._fail(key, f"the quaternion x, y, z, w has norm {norm:.4g} instead of 1.")
        return unit

    def _stamp(self, row):
        text = row.text(self._time)
        try:
            ticks = (parsed(row.figure(self._time), decimal.Decimal) * self._time_factor + self._offset).to_integral_value()
            is_stamp = 0 < ticks <= LATEST
        except (ArithmeticError, ValueError):  # of decimal: no number, none to compare, or one beyond its exponents
            row.fail(f'"{excerpt(text, 40)}" is not a time.', self._time)
        if not is_stamp:
            seconds = float(ticks) * 1e-9
            row.fail(f"{seconds:g} s is no stamp: they lie between 0 and 2^32 s; mend it by time.offset.", self._time)
        return genpy.Time(0, int(ticks))

    def messages(self):
        """Stamp and message of each line; lines without values, of a tracker that sees nothing, are left out."""
        make = getattr(self, "_" + self.topic)()
        for row in self._table.rows():
            if all(row.is_empty(column) for column in self._columns):
                self.left_out += 1
                continue
            values = [row.number(column, factor) for column, factor in zip(self._columns, self._factors)]
            message = make(row, values)
            message.header.stamp = self._stamp(row)
            yield message.header.stamp, message

    def _joint_states(self):
        names = [joint["name"] for joint in self._actuator["joints"]]
        if not names:
            self._fail("stream", "the description has no joints; leave their readings out.")
        untold = [index for index, column in enumerate(self._columns) if not self._is_unit_told(column)]

        def make(_row, values):
            self._largest_untold = max([self._largest_untold, *(abs(values[index]) for index in untold)])
            return JointState(name=names, position=values)

        return make

    def _is_unit_told(self, column):
        return self._entry.get("unit") is not None or bool(named(self._table.titles[column])[1])

    def summary(self, count):
        """What was written, in words."""
        text = f"{self.topic}: {count} measurements"
        if self.left_out:
            text += f", {self.left_out} lines without values left out"
        if self._largest_untold > 2.0 * math.pi:
            text += (
                f"; its angles reach {self._largest_untold:.3g}, and count as radians: if they are degrees, write "
                "unit: deg to this stream"
            )
        return text

    def _coil_currents(self):
        return lambda _row, values: CoilCurrents(current=values)

    def _measured_orientation(self):
        tracker = self._rotation(self._numbers("stator_tracker", 4, IDENTITY), "stator_tracker")
        marker = self._rotation(self._numbers("rotor_marker", 4, IDENTITY), "rotor_marker")

        def make(row, values):
            measured = unit_quaternion(row, values, self._columns[0])
            message = QuaternionStamped()
            message.header.frame_id = "stator"
            message.quaternion = Quaternion(*product(product(tracker, measured), inverse(marker)))
            return message

        return make

    def _measured_torque(self):
        pose = self._numbers("rotor_ft_sensor", 7, [0.0, 0.0, 0.0, *IDENTITY])
        lever, rotation = pose[:3], self._rotation(pose[3:], "rotor_ft_sensor")
        force, force_factors = [], []
        if "force" in self._entry:
            force, force_factors = self._value_columns("force", 3, "N", "force_unit")
        elif any(lever):
            self._fail("rotor_ft_sensor", "a sensor beside the rotor's centre needs the columns of its force, too.")

        def make(row, values):
            torque = rotated(rotation, values)
            if force:
                measured = [row.number(column, factor) for column, factor in zip(force, force_factors)]
                torque = [a + b for a, b in zip(torque, cross(lever, rotated(rotation, measured)))]
            message = Vector3Stamped(vector=Vector3(*torque))
            message.header.frame_id = "rotor"
            return message

        return make


def streams_of(path, content, actuator):
    """The streams that the content of a YAML file at `path` names."""
    if not isinstance(content, dict) or set(content) != {"streams"} or not isinstance(content["streams"], list):
        raise TableError(f"{path}: its one key is streams, a list.")
    streams = []
    for number, entry in enumerate(content["streams"]):
        where = f"{path}: streams[{number}]"
        if not isinstance(entry, dict):
            raise TableError(f"{where}: it is a map.")
        streams.append(Stream(entry, where, os.path.dirname(path), actuator))
    if not streams:
        raise TableError(f"{path}: streams: there is none.")
    return streams
