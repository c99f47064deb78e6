"""A calibrated actuator for programs in Python: orientation, torque and currents, each with its uncertainty.

    with CalibratedActuator("calibrated.yaml") as actuator:
        pose = actuator.orientation([0.1, 0.0, 0.5])
        print(pose.quaternion_xyzw, "+-", pose.stddev)

The numbers are those of the C++ class of the same name: its program `actuator_model` answers through a pipe, some ten
thousand times a second. SI units; torques in the rotor frame; joint angles are raw readings. A rotor without joints is
asked at the unit quaternion that the tracker measures, in their place, and not for its orientation.
"""

import contextlib
import os
import subprocess
import typing
import warnings

from .programs import program as program_path

PROGRAM = "actuator_model"
COIL_CURRENT = 2.5  # [A] at most through one coil, where nobody states another
PATIENCE = 2.0  # [s] for it to end by itself


class Orientation(typing.NamedTuple):
    quaternion_xyzw: list  # rotates rotor into stator coordinates
    stddev: float  # of a component of the rotation error [rad]
    is_supported: bool  # False far from all points of an orientation map


class Torque(typing.NamedTuple):
    torque: list  # of the coils on the rotor, rotor frame [N m]
    stddev: float  # of a component [N m]


class Currents(typing.NamedTuple):
    outcome: str  # reached; limited: less torque than asked for; singular: none, and no currents
    currents: list  # of every coil [A]
    stddevs: list  # of the least change of each by which the torque would be made in truth [A]
    torque: list  # that they make, rotor frame [N m]
    torque_stddev: float  # of a component [N m]


class CalibratedActuator:
    """Not for several threads at a time. Ctrl-C leaves it usable, unless it came in the middle of a question."""

    def __init__(self, description, program=None):
        """`program`: path of actuator_model, where ROS does not know the package. Raises ValueError with what is wrong
        with the description."""
        self._process = subprocess.Popen(
            [program or program_path(PROGRAM), "--actuator", os.fspath(description)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            bufsize=1,
            # Ctrl-C reaches all of a terminal's session; who catches it may have a last current to ask for. The end of
            # its standard input ends the program, also where this one is killed.
            start_new_session=True,
        )
        words = self._process.stdout.readline().split()
        if not words:
            message = self._process.stderr.read().strip()
            self.close()
            raise ValueError(message)
        self.coils = int(words[1])  # 0 without a torque model
        self.has_uncertainty = words[2] == "1"  # of parameters; a description as drawn states none
        self.is_as_drawn = words[4] == "1"  # it is not told how well each angle of its axes is known
        self.is_contradicted = words[3] == "1"  # by what was held out when the description was made
        if self.is_contradicted:
            self._warn(f"{description} was contradicted by what was held out: do not use it, calibrate anew.")

    def _warn(self, message):
        try:
            warnings.warn(message, RuntimeWarning, 3)
        except RuntimeWarning:  # made an error by a filter
            self.close()
            raise

    def close(self):
        """Ends the program; what is asked later raises RuntimeError."""
        for pipe in (self._process.stdin, self._process.stdout, self._process.stderr):
            # What could not be written any more is flushed once more.
            with contextlib.suppress(OSError):
                pipe.close()
        try:
            self._process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def _ask(self, question, *numbers):
        words = [question, *(repr(float(number)) for group in numbers for number in group)]
        answer = self._answer(" ".join(words) + "\n")
        if not answer:
            raise RuntimeError(f"{PROGRAM} has ended")
        if answer.startswith("error: "):
            raise ValueError(answer[len("error: ") :].strip())
        return answer.split()

    def _answer(self, line):
        """Empty where there is none any more."""
        if self._process.stdin.closed:
            return ""
        try:
            self._process.stdin.write(line)
            self._process.stdin.flush()
            return self._process.stdout.readline()
        except OSError:
            return ""
        except BaseException:
            # What is left of this answer would be taken for that to the next question.
            self.close()
            raise

    def orientation(self, joints):
        """At joint readings [rad]."""
        *numbers, supported = self._ask("orientation", joints)
        values = [float(number) for number in numbers]
        return Orientation(values[:4], values[4], supported == "1")

    def torque(self, joints, currents):
        """Also at currents, one for each coil [A]."""
        values = [float(number) for number in self._ask("torque", joints, currents)]
        return Torque(values[:3], values[3])

    def currents(self, torque, joints, limit=COIL_CURRENT):
        """Of least power for a torque [N m, rotor frame], none beyond `limit` [A]."""
        outcome, *numbers = self._ask("currents", torque, joints, [limit])
        values = [float(number) for number in numbers]
        coils = self.coils
        made = values[2 * coils :]
        return Currents(outcome, values[:coils], values[coils : 2 * coils], made[:3], made[3])
