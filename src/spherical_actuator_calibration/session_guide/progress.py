"""How far a session has come, and what is left, from samples and plan. No ROS."""

import dataclasses
import math


@dataclasses.dataclass(frozen=True)
class Pose:
    """A pose to measure at: raw joint angles [rad], or turns of a rotor without joints, and patterns of coils to
    excite in turn.

    A pattern holds the numbers of the coils that are excited at once, counted from 1, ascending, negative where the
    current is; it is empty without current.
    """

    joints: tuple
    excitations: tuple
    validation: bool = False

    def way_from(self, joints):
        """[rad] by which each joint is to turn from these angles, the shorter way round."""
        return [difference(wanted, angle) for wanted, angle in zip(self.joints, joints)]


@dataclasses.dataclass(frozen=True)
class Measured:
    """What counts of a sample here, as the calibration node tells it (list_samples): the number of its place, the coils
    that it excites, and whether it is held out."""

    place: int
    pattern: tuple
    validation: bool


def joint_stddev(joints):
    """[rad] of the axis or offset that is known worst, by the messages of the joints; 0 while one is not known."""
    worst = max(max(joint.offset_stddev, *joint.axis_stddev) for joint in joints)
    return worst if math.isfinite(worst) else 0.0


def in_words(pattern):
    """Coil 3; coils +1 -4."""
    if len(pattern) == 1 and pattern[0] > 0:
        return f"Coil {pattern[0]}"
    return "Coils " + " ".join(f"{coil:+d}" for coil in pattern)


def in_degrees(angle):
    """+4.8°: an angle [rad] with its sign."""
    return f"{math.degrees(angle):+.1f}\N{DEGREE SIGN}"


def difference(angle, other):
    """Of two angles [rad]; a full turn makes none."""
    return math.remainder(angle - other, math.tau)


def distance(joints, others):
    """The largest difference of joint angles [rad]."""
    return max((abs(difference(one, other)) for one, other in zip(joints, others)), default=0.0)


def way_to(pose, names, joints, tolerance):
    """What is left to turn: "joint_1 by +4.8°, joint_3 by -30.0°"; empty at the pose."""
    left = zip(names, pose.way_from(joints))
    return ", ".join(f"{name} by {in_degrees(way)}" for name, way in left if abs(way) > tolerance)


def patterns_to_capture(there):
    """In their order, by the PoseProgress of a pose; first that without current: its torque is taken off the others of
    the same rest, and a new visit is a new rest. None where the pose is measured."""
    return [] if there.is_measured else [(), *(tuple(pattern.coils) for pattern in there.missing)]


def service_of(cycle):
    """Service and coil of a cycle as the calibration node names it: "coil:3" gives ("calibrate_coil", 3)."""
    name, _, coil = cycle.partition(":")
    return name if name == "refine" else "calibrate_" + name, int(coil or 0)


class Progress:
    """Captures done and left, and the time that they will take."""

    def __init__(self, captures, clock):
        self.total = captures
        self.done = 0
        self._clock = clock
        self._begin = clock()

    def advance(self, captures=1):
        self.done += captures

    def remaining_time(self):
        """[s] at the rate so far; None before the first capture."""
        if self.done == 0:
            return None
        return (self._clock() - self._begin) / self.done * (self.total - self.done)


def bar(done, total, remaining, width=30):
    """[####......] 4/10, 30 s left; remaining [s]: None or negative where it is not known."""
    share = min(1.0, done / total) if total else 1.0
    filled = int(round(share * width))
    left = "" if remaining is None or remaining < 0.0 else f", {duration(remaining)} left"
    return f"[{'#' * filled}{'.' * (width - filled)}] {done}/{total}{left}"


def duration(seconds):
    """45 s, 3 min, 2 h 05 min."""
    if seconds < 100.0:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60.0)
    return f"{minutes} min" if minutes < 60 else f"{minutes // 60} h {minutes % 60:02d} min"
