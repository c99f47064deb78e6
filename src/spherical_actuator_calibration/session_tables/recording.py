"""Recordings that calibrate_bag reads, made of tables."""

import contextlib
import os
import subprocess

import genpy
import rosbag
from std_msgs.msg import String

from spherical_actuator_calibration.msg import ActuatorParameters
from spherical_actuator_calibration.text_files import (
    LARGEST_CONFIGURATION,
    other_kind,
    parsed_yaml,
    read_yaml,
    require_separate_files,
)

from ..programs import program
from .sample_messages import SPACING, SampleTable
from .stream_messages import streams_of
from .table import TableError


DESCRIBER = "actuator_model"


def described(path):
    """Text of a description as the calibration node records it: of what the core accepts, with the table of its torque
    curve in it. Raises TableError in the words of the core."""
    said = subprocess.run(
        [program(DESCRIBER), f"--actuator={path}", "--describe"],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        encoding="utf-8",
        errors="replace",
        check=False,
    )
    if said.returncode != 0:
        words = said.stderr.strip() or f"{DESCRIBER} ended with status {said.returncode}."
        raise TableError(words[len(DESCRIBER) + 2 :] if words.startswith(f"{DESCRIBER}: ") else words)
    return said.stdout


class Recording:
    """A bag that appears when it is whole."""

    def __init__(self, path, ns, actuator_path):
        self.path = path
        self._active = path + ".active"
        self._prefix = "/" + ns.strip("/") + "/" if ns.strip("/") else "/"
        self._text = described(actuator_path)
        self.actuator = parsed_yaml(self._text, actuator_path)["actuator"]
        self._bag = None

    def __enter__(self):
        kind = other_kind(self._active, follow=False)
        if kind:
            raise TableError(f"{self._active}: is {kind}, not a file; remove it.")
        try:
            self._bag = rosbag.Bag(self._active, "w")
        except OSError as error:
            raise self._unwritable(error) from error
        return self

    def __exit__(self, _kind, error, _trace):
        try:
            if error is None:
                self._bag.close()
                os.replace(self._active, self.path)
        except OSError as failure:
            error = failure
        if error is None:
            return
        # On a full disk its end cannot be written either.
        with contextlib.suppress(OSError):
            self._bag.close()
        with contextlib.suppress(OSError):
            os.unlink(self._active)
        if isinstance(error, OSError):
            raise self._unwritable(error) from error

    def _unwritable(self, error):
        return TableError(f"{self.path}: cannot be written: {error.strerror or error}.")

    def files(self):
        """That it writes, and by which option."""
        return [("--output", self.path), ("--output", self._active)]

    def write(self, topic, stamp, message):
        self._bag.write(self._prefix + topic, message, stamp)

    def describe(self, stamp):
        """Says whose recording it is, and by which description."""
        # Of which only the unit is read.
        unit = ActuatorParameters(actuator=self.actuator["name"], serial=self.actuator.get("serial", ""))
        unit.header.stamp = stamp
        unit.header.frame_id = "stator"
        unit.source = "nominal"
        self.write("parameters", stamp, unit)
        self.write("calibration_description", stamp, String(data=self._text))


def record_samples(recording, path):
    """Writes the samples of a table; returns what was written, in words."""
    actuator = recording.actuator
    samples = SampleTable(path, len(actuator.get("coils", [])), bool(actuator["joints"])).messages()
    with recording:
        stamp = genpy.Time(0, SPACING)
        recording.describe(stamp)
        for number, sample in enumerate(samples, 1):
            sample.header.frame_id = "stator"
            recording.write("samples", genpy.Time(0, number * SPACING), sample)
    return [f"{len(samples)} samples"]


def record_streams(recording, path):
    """Writes the streams that a YAML file describes; returns what was written, in words."""
    streams = streams_of(path, read_yaml(path, LARGEST_CONFIGURATION), recording.actuator)
    require_separate_files([(path, stream.path) for stream in streams], recording.files())
    lines, spans = [], {}
    with recording:
        for number, stream in enumerate(streams):
            count, span = _write_stream(recording, stream, is_first=not spans)
            if span is not None:
                _require_apart(path, number, stream.topic, span, spans)
                spans[number] = stream.topic, span
            lines.append(stream.summary(count))
        if not spans:
            raise TableError(f"{path}: the files hold no measurement.")
        _require_common_time(path, spans.values())
    return lines


def _require_common_time(path, spans):
    """Of all streams with the first of them. Raises TableError."""
    whole = {}
    for topic, (begin, end) in spans:
        known = whole.get(topic, (begin, end))
        whole[topic] = min(begin, known[0]), max(end, known[1])
    first, (begin, end) = next(iter(whole.items()))
    for topic, (other_begin, other_end) in whole.items():
        if other_begin > end or begin > other_end:
            raise TableError(
                f"{path}: {topic}, from {other_begin.to_sec():.3f} to {other_end.to_sec():.3f} s, and {first}, from "
                f"{begin.to_sec():.3f} to {end.to_sec():.3f} s, have no time in common: mend their time.offset."
            )


def _write_stream(recording, stream, is_first):
    """How many measurements, and the first and the last stamp; None of none."""
    count, span = 0, None
    for stamp, message in stream.messages():
        if is_first and count == 0:
            recording.describe(stamp)
        recording.write(stream.topic, stamp, message)
        count += 1
        span = (min(span[0], stamp), max(span[1], stamp)) if span else (stamp, stamp)
    return count, span


def _require_apart(path, number, topic, span, spans):
    """Files of one stream follow each other. Raises TableError."""
    for other, (other_topic, other_span) in spans.items():
        if topic == other_topic and span[0] <= other_span[1] and other_span[0] <= span[1]:
            raise TableError(
                f"{path}: streams[{other}] and streams[{number}] are both {topic}, and overlap in time, from "
                f"{max(span[0], other_span[0]).to_sec():.3f} to {min(span[1], other_span[1]).to_sec():.3f} s: one sensor is "
                "read once; take out the lines that both have, or one of the files."
            )
