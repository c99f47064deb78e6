"""Goals of the actions: what they leave at zero is as the options have it by default."""

import dataclasses
import math
import os

from spherical_actuator_calibration.msg import SessionGoal

from .calibration import excitations_of
from .options import CURRENT, OptionError, Options
from .progress import Pose

PLAIN = ("seed", "wanted_stddev", "drive_fixture", "skip_linearity")  # zero means zero
WITH_NONE = ("validation_poses", "settling")  # negative: none
PATHS = ("plan", "repeat")
DEFAULTS = dataclasses.asdict(Options())


def options_of(goal, ns):
    """Options of a SessionGoal. Raises OptionError."""
    values = {}
    for field in goal.__slots__:
        value = getattr(goal, field)
        if field in PATHS:
            value = value or None
        elif field in WITH_NONE and value < 0:
            value = type(value)(0)
        elif field not in PLAIN and not value:
            value = DEFAULTS[field]
        values[field] = value
    return Options(ns=ns, **values)


def goal_of(options):
    """The SessionGoal that has these options."""
    values = {field: getattr(options, field) for field in SessionGoal.__slots__}
    for field, value in values.items():
        if field in PATHS:
            values[field] = os.path.abspath(value) if value else ""
        elif field in WITH_NONE:
            values[field] = 0 if value is None else value or -1
        elif value is None:
            values[field] = 0
    return SessionGoal(**values)


def options_of_capture(goal, ns):
    """Options of a CaptureGoal. Raises OptionError."""
    default = Options()
    settling = goal.settling or Options(drive_fixture=True).rest
    current = abs(goal.current) or _current_of_patterns(goal.pose) or CURRENT
    try:
        return Options(
            ns=ns,
            current=current,
            total_current=max(default.total_current, current),
            dwell=goal.duration or default.dwell,
            settling=0.0 if settling < 0.0 else settling,
            drive_fixture=bool(goal.drive_fixture),
        )
    except OptionError as error:
        raise OptionError("duration" if error.option == "dwell" else error.option, error.reason) from None


def pose_of_capture(goal):
    """The pose of a CaptureGoal, with the signs that its current asks for."""
    sign = -1 if goal.current < 0.0 else 1
    excitations = tuple(tuple(sign * coil for coil in pattern) for pattern in excitations_of(goal.pose))
    return Pose(tuple(goal.pose.joint_position), excitations, bool(goal.validation))


def _current_of_patterns(planned):
    """[A] that every excited coil has in patterns of a PlannedPose, 0 where it has none. Raises OptionError where they
    differ: a capture has one."""
    currents = {abs(current) for pattern in planned.patterns for current in pattern.current} - {0.0}
    if len(currents) > 1:
        raise OptionError(
            "pose.patterns",
            f"excited coils have from {min(currents):g} to {max(currents):g} A, and a capture has one current for all: "
            "state it as current, or capture them one after the other.",
        )
    return currents.pop() if currents else 0.0


def require_patterns(planned, count):
    """Raises OptionError unless each pattern of a PlannedPose has a current for each of so many coils, one at least not
    zero."""
    for number, pattern in enumerate(planned.patterns, 1):
        currents = pattern.current
        if len(currents) != count:
            raise OptionError("pose.patterns", f"pattern {number} has {len(currents)} currents for {count} coils.")
        if not all(map(math.isfinite, currents)) or not any(currents):
            raise OptionError("pose.patterns", f"pattern {number} has no current, or one that is no number.")


def checked_pattern(coils, count):
    """Coils of an ExciteGoal in their order. Raises ValueError where an actuator with so many coils has no such."""
    numbers = [abs(coil) for coil in coils]
    if not numbers or len(set(numbers)) != len(numbers) or not all(1 <= number <= count for number in numbers):
        raise ValueError(f"coils: different numbers from 1 to {count} are wanted, negative where the current is.")
    return tuple(sorted(coils, key=abs))
