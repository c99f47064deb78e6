"""Poses from files: a plan of plan_session, or an earlier session."""

import dataclasses
import math
import re
import sqlite3
import statistics

from ..session_tables.export import ExportError
from ..session_tables.export import Session as StoredSession
from ..text_files import LARGEST_CONFIGURATION, TextFileError, read_yaml
from .progress import Pose, excited_coils, poses_of

SIGNED_COIL = re.compile(r"[+-][1-9]\d{0,5}")


class PlanError(ValueError):
    """Why a file gives no poses, in a sentence that names it."""


@dataclasses.dataclass(frozen=True)
class Plan:
    """Poses in their order, and the current [A] that excites a coil."""

    poses: tuple
    current: float


def read_plan(path, actuator):
    """A plan of plan_session for an actuator, given as its description. Raises PlanError."""
    try:
        content = read_yaml(path, LARGEST_CONFIGURATION)
    except (OSError, TextFileError) as error:
        raise PlanError(str(error)) from error
    plan = content.get("session_plan") if isinstance(content, dict) else None
    if not isinstance(plan, dict):
        raise PlanError(f"{path}: this is no plan of plan_session: the key session_plan is missing.")
    _require_unit(path, actuator, plan.get("actuator"), plan.get("serial"))
    assumed = plan.get("assumed")
    current = assumed.get("current") if isinstance(assumed, dict) else None
    if not _is_number(current) or current <= 0.0:
        raise PlanError(f"{path}: assumed/current is no current [A].")
    poses = plan.get("poses")
    if not isinstance(poses, list) or not poses:
        raise PlanError(f"{path}: poses is no list of poses.")
    coils = len(actuator.get("coils", []))
    tilt = actuator["workspace"]["tilt_limit"]
    found = tuple(_pose(f"{path}: pose {number}", pose, coils) for number, pose in enumerate(poses, 1))
    for number, pose in enumerate(found, 1):
        if max(abs(pose.joints[0]), abs(pose.joints[1])) > tilt + 1e-9:
            raise PlanError(f"{path}: pose {number} is beyond the workspace's tilt_limit of {tilt} rad.")
    return Plan(found, float(current))


def read_session(path, actuator, threshold, tolerance):
    """What an earlier session measured of this actuator: its poses and patterns, held-out ones as such.

    threshold [A]: a coil below it was off; tolerance [rad]: of one pose. Raises PlanError.
    """
    try:
        with StoredSession(path) as session:
            name, serial = session.rows("SELECT name, serial FROM unit")[0]
            _require_unit(path, actuator, name, serial)
            samples = session.rows("SELECT * FROM samples WHERE removal IS NULL ORDER BY id")
            currents = {}
            for row in session.rows("SELECT sample, current FROM sample_currents ORDER BY sample, coil"):
                currents.setdefault(row["sample"], []).append(row["current"])
    except (ExportError, sqlite3.Error, LookupError) as error:
        raise PlanError(str(error) if isinstance(error, ExportError) else f"{path}: {error}.") from error
    return _repeated(path, samples, currents, threshold, tolerance)


def _repeated(path, samples, currents, threshold, tolerance):
    places = poses_of([_place(row) for row in samples], tolerance)
    patterns = [[] for _ in places]
    strengths = []
    for row in samples:
        there = next(
            n
            for n, pose in enumerate(places)
            if pose.validation == bool(row["validation"]) and pose.is_at(_place(row).joints, tolerance)
        )
        carried = currents.get(row["id"], [])
        pattern = excited_coils(carried, threshold)
        strengths += [abs(carried[abs(coil) - 1]) for coil in pattern]
        if pattern and pattern not in patterns[there]:
            patterns[there].append(pattern)
    if not places:
        raise PlanError(f"{path}: it holds no samples in use.")
    poses = tuple(
        dataclasses.replace(pose, excitations=tuple(excitations)) for pose, excitations in zip(places, patterns)
    )
    return Plan(poses, round(statistics.median(strengths), 2) if strengths else 0.0)


@dataclasses.dataclass(frozen=True)
class _Place:
    joints: tuple
    validation: bool


def _place(row):
    return _Place((row["joint_1"], row["joint_2"], row["joint_3"]), bool(row["validation"]))


def _require_unit(path, actuator, name, serial):
    if name != actuator["name"]:
        raise PlanError(f"{path}: it is for the actuator {name}, not for {actuator['name']}.")
    own = actuator.get("serial", "")
    if serial and own and serial != own:
        raise PlanError(f"{path}: it is for the serial number {serial}, not for {own}.")


def _pose(place, pose, coils):
    joints = pose.get("joint_position") if isinstance(pose, dict) else None
    if not isinstance(joints, list) or len(joints) != 3 or not all(map(_is_number, joints)):
        raise PlanError(f"{place}: joint_position is not of three angles [rad].")
    single, patterns = pose.get("coils"), pose.get("patterns")
    if not isinstance(single, list) or not isinstance(patterns, (list, type(None))):
        raise PlanError(f"{place}: coils or patterns are no list.")
    if patterns is None:
        patterns = [f"+{coil}" for coil in single]
    found = tuple(_pattern(place, pattern, coils) for pattern in patterns)
    if any(abs(coil) not in single for pattern in found for coil in pattern):
        raise PlanError(f"{place}: a pattern excites a coil that is not among the coils.")
    return Pose(tuple(map(float, joints)), found)


def _pattern(place, text, coils):
    words = text.split() if isinstance(text, str) else []
    if not words or not all(map(SIGNED_COIL.fullmatch, words)):
        raise PlanError(f'{place}: "{text}" is no pattern such as "+1 -4".')
    pattern = tuple(map(int, words))
    if any(abs(one) >= abs(next_one) for one, next_one in zip(pattern, pattern[1:])):
        raise PlanError(f'{place}: "{text}": coils ascend, each at most once.')
    if max(map(abs, pattern)) > coils:
        raise PlanError(f'{place}: "{text}" names a coil beyond the {coils} that there are.')
    return pattern


def _is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)
