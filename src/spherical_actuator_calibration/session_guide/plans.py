"""Poses that a session takes from a file, and those of an earlier session."""

import dataclasses
import sqlite3
import statistics

from ..session_tables.export import ExportError
from ..session_tables.export import Session as StoredSession
from ..unit_identity import other_unit
from .progress import Pose, excited_coils, poses_of


class PlanError(ValueError):
    """Why a file gives no poses, in a sentence that names it."""


@dataclasses.dataclass(frozen=True)
class Plan:
    """Poses in their order, and the current [A] that excites a coil."""

    poses: tuple
    current: float


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
    other = other_unit(name, serial, actuator["name"], actuator.get("serial", ""))
    if other is not None:
        raise PlanError(f"{path}: it is for the {other[0]}, not for {other[1]}.")
