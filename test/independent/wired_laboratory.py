"""A laboratory in NumPy, written from doc/method.md: actuators with errors, and sessions measured on them.

It shares no code with the package, which it judges. Everything random comes from a seeded generator. Angles in rad,
torques in N*m, currents in A; R maps rotor coordinates to stator coordinates; joints, poles and coils count from 0.
"""

import dataclasses
import math

import numpy as np

COEFFICIENTS = (-5.40e-3, 5.18e-2, -3.73e-6, -4.2e-4, 2.39e-5, -5.07e-7, 3.78e-9)  # [N*m/A], angle in degrees
BLEND_START = 2.0  # [deg]
SUPPORT = (28.0, 32.0)  # [deg]


def turn(axis, angle):
    """Rotation by Rodrigues' formula; of single numbers, which takes a fifth of the time of small arrays."""
    x, y, z = (float(one) for one in axis)
    length = math.sqrt(x * x + y * y + z * z)
    x, y, z = x / length, y / length, z / length
    c, s = math.cos(angle), math.sin(angle)
    v = 1.0 - c
    return np.array([
        [c + v * x * x, v * x * y - s * z, v * x * z + s * y],
        [v * x * y + s * z, c + v * y * y, v * y * z - s * x],
        [v * x * z - s * y, v * y * z + s * x, c + v * z * z],
    ])


def cross_product(a, b):
    """Of two vectors; numpy's is for arrays of many."""
    (x, y, z), (u, v, w) = a.tolist(), b.tolist()
    return np.array([y * w - z * v, z * u - x * w, x * v - y * u])


def small_turn(generator, stddev):
    """Rotation by a random vector."""
    vector = stddev * generator.standard_normal(3)
    angle = np.linalg.norm(vector)
    return np.eye(3) if angle == 0 else turn(vector, angle)


def quaternion(rotation):
    """x, y, z, w of a rotation matrix."""
    values, vectors = np.linalg.eigh(_bilinear(rotation))
    return vectors[:, np.argmax(values)]


def _bilinear(m):
    """The symmetric matrix whose largest eigenvector is the quaternion x, y, z, w."""
    return np.array([
        [m[0, 0] - m[1, 1] - m[2, 2], m[0, 1] + m[1, 0], m[0, 2] + m[2, 0], m[2, 1] - m[1, 2]],
        [m[0, 1] + m[1, 0], m[1, 1] - m[0, 0] - m[2, 2], m[1, 2] + m[2, 1], m[0, 2] - m[2, 0]],
        [m[0, 2] + m[2, 0], m[1, 2] + m[2, 1], m[2, 2] - m[0, 0] - m[1, 1], m[1, 0] - m[0, 1]],
        [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], m[0, 0] + m[1, 1] + m[2, 2]],
    ])


def rotation_of(xyzw):
    """Rotation matrix of a quaternion."""
    x, y, z, w = np.asarray(xyzw) / np.linalg.norm(xyzw)
    vector = np.array([x, y, z])
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + 2 * w * cross + 2 * (np.outer(vector, vector) - vector @ vector * np.eye(3))


def _curve_and_slope(degrees):
    value = sum(c * degrees**n for n, c in enumerate(COEFFICIENTS))
    slope = sum(n * c * degrees ** (n - 1) for n, c in enumerate(COEFFICIENTS) if n > 0)
    return value, slope


def torque_curve(psi):
    """Torque of a pole and a coil at an angle [N*m/A]: odd cubic, polynomial, cubic to zero."""
    degrees = math.degrees(psi)
    if degrees < BLEND_START:
        value, slope = _curve_and_slope(BLEND_START)
        cubic = (slope * BLEND_START - value) / (2 * BLEND_START**3)
        return (value / BLEND_START - cubic * BLEND_START**2) * degrees + cubic * degrees**3
    if degrees < SUPPORT[0]:
        return _curve_and_slope(degrees)[0]
    if degrees < SUPPORT[1]:
        value, slope = _curve_and_slope(SUPPORT[0])
        width = SUPPORT[1] - SUPPORT[0]
        t = (degrees - SUPPORT[0]) / width
        return value * (1 + 2 * t) * (1 - t) ** 2 + slope * width * t * (1 - t) ** 2
    return 0.0


def direction(angles):
    """Unit vector of elevation and azimuth."""
    polar, azimuth = angles
    return np.array([np.cos(polar) * np.cos(azimuth), np.cos(polar) * np.sin(azimuth), np.sin(polar)])


@dataclasses.dataclass
class Machine:
    """One actuator, as drawn or as made."""

    axes: np.ndarray  # 3x3, one row for each joint
    offsets: np.ndarray
    poles: np.ndarray  # m x 3, unit, rotor frame
    polarity: np.ndarray
    coils: np.ndarray  # l x 3, unit, stator frame
    pole_strength: np.ndarray
    coil_strength: np.ndarray
    pole_angles: np.ndarray = None  # of a drawing: elevation and azimuth
    coil_angles: np.ndarray = None

    def orientation(self, q):
        rotation = np.eye(3)
        for axis, angle in zip(self.axes, np.asarray(q) + self.offsets):
            rotation = rotation @ turn(axis, angle)
        return rotation

    def torque(self, rotation, current):
        total = np.zeros(3)
        for coil in np.flatnonzero(current):
            s = rotation.T @ self.coils[coil]
            cosines = self.poles @ s
            for pole in np.flatnonzero(cosines > np.cos(np.radians(SUPPORT[1]))):
                cross = cross_product(self.poles[pole], s)
                sine = math.sqrt(cross @ cross)
                if sine > 1e-9:
                    strength = self.polarity[pole] * self.pole_strength[pole] * self.coil_strength[coil]
                    total += strength * current[coil] * torque_curve(np.arctan2(sine, cosines[pole])) * cross / sine
        return total


def drawing(poles=8, coils=(12, 12), pole_elevation=0.0, coil_elevation=0.2618, axes=None):
    """An actuator as drawn: poles around the equator, coils in two layers."""
    pole_angles = [(pole_elevation * (-1) ** i, 2 * np.pi * i / poles) for i in range(poles)]
    coil_angles = [
        ((1 - 2 * layer) * coil_elevation, 2 * np.pi * j / count)
        for layer, count in enumerate(coils)
        for j in range(count)
    ]
    return Machine(
        axes=np.eye(3) if axes is None else np.array([np.array(axis, float) / np.linalg.norm(axis) for axis in axes]),
        offsets=np.zeros(3),
        poles=np.array([direction(angles) for angles in pole_angles]).reshape(-1, 3),
        polarity=np.array([(-1) ** i for i in range(poles)]),
        coils=np.array([direction(angles) for angles in coil_angles]).reshape(-1, 3),
        pole_strength=np.ones(poles),
        coil_strength=np.ones(len(coil_angles)),
        pole_angles=np.array(pole_angles).reshape(-1, 2),
        coil_angles=np.array(coil_angles).reshape(-1, 2),
    )


def made(machine, generator, tolerance=0.03, strength=0.01):
    """A unit of that drawing: every axis turned, every offset and strength off."""
    return Machine(
        axes=np.array([small_turn(generator, tolerance) @ axis for axis in machine.axes]),
        offsets=tolerance * generator.standard_normal(3),
        poles=np.array([small_turn(generator, tolerance) @ pole for pole in machine.poles]).reshape(-1, 3),
        polarity=machine.polarity.copy(),
        coils=np.array([small_turn(generator, tolerance) @ coil for coil in machine.coils]).reshape(-1, 3),
        pole_strength=1 + strength * generator.standard_normal(len(machine.poles)),
        coil_strength=1 + strength * generator.standard_normal(len(machine.coils)),
    )


@dataclasses.dataclass
class Measured:
    """One sample: what the sensors tell. Orientation and torque are None where they were not measured."""

    q: np.ndarray
    orientation: np.ndarray = None
    torque: np.ndarray = None
    current: np.ndarray = None


@dataclasses.dataclass
class Noise:
    """Standard deviations, as stated and as they are."""

    orientation: float = 5e-4
    torque: float = 3e-4
    joint: float = 2e-5


def session(machine, generator, orientations=20, torques=160, tilt=0.5, current=2.0, tracked=False, noise=None):
    """Orientations at random poses, and torques of single coils in turn where some pole is in reach."""
    noise = noise or Noise()
    samples = []
    for _ in range(orientations):
        samples.append(_orientation(machine, _pose(generator, tilt), generator, noise))
    for n in range(torques):
        coil = n % len(machine.coils)
        pose = _pose_in_reach(machine, coil, generator, tilt)
        currents = np.zeros(len(machine.coils))
        currents[coil] = current
        sample = _orientation(machine, pose, generator, noise) if tracked else Measured(pose)
        sample.current = currents
        sample.torque = machine.torque(machine.orientation(pose), currents)
        sample.torque = sample.torque + noise.torque * generator.standard_normal(3)
        samples.append(sample)
    for sample in samples:
        sample.q = sample.q + noise.joint * generator.standard_normal(3)
    return samples


def _pose(generator, tilt):
    return np.append(generator.uniform(-tilt, tilt, 2), generator.uniform(-np.pi, np.pi))


def _orientation(machine, pose, generator, noise):
    return Measured(pose, machine.orientation(pose) @ small_turn(generator, noise.orientation))


def _pose_in_reach(machine, coil, generator, tilt):
    """A pose at which some pole lies where the curve is neither flat nor uncertain."""
    for _ in range(50):
        pose = _pose(generator, tilt)
        angles = np.degrees(np.arccos(np.clip(machine.poles @ machine.orientation(pose).T @ machine.coils[coil], -1, 1)))
        if np.any((angles > 4) & (angles < 24)):
            break
    return pose


def actuator_yaml(machine, name="independent"):
    """Description of a drawing."""
    lines = ["actuator:", f"  name: {name}", "  joints:"]
    for k, axis in enumerate(machine.axes):
        lines.append(f"    - {{name: joint_{k + 1}, axis: {numbers(axis)}, offset: {number(machine.offsets[k])}}}")
    if len(machine.poles) and len(machine.coils):
        lines.append("  poles:")
        for (polar, azimuth), polarity in zip(machine.pole_angles, machine.polarity):
            lines.append(f"    - {{polar: {number(polar)}, azimuth: {number(azimuth)}, polarity: {polarity}}}")
        lines.append("  coils:")
        for polar, azimuth in machine.coil_angles:
            lines.append(f"    - {{polar: {number(polar)}, azimuth: {number(azimuth)}}}")
        lines.append("  torque_curve:")
        lines.append("    angle_unit: deg")
        lines.append(f"    coefficients: {numbers(COEFFICIENTS)}")
        lines.append(f"    blend_start: {BLEND_START}")
        lines.append(f"    support: {numbers(SUPPORT)}")
    lines.append("  workspace: {tilt_limit: 0.6}")
    return "\n".join(lines) + "\n"


def samples_yaml(samples, noise=None):
    """Samples in the form of doc/interfaces.md, with the stated noise."""
    noise = noise or Noise()
    lines = [
        f"orientation_stddev: {number(noise.orientation)}",
        f"torque_stddev: {number(noise.torque)}",
        "samples:",
    ]
    for sample in samples:
        lines.append(f"  - joint_position: {numbers(sample.q)}")
        lines.append(f"    joint_stddev: {numbers([noise.joint] * 3)}")
        if sample.orientation is not None:
            lines.append(f"    orientation_xyzw: {numbers(quaternion(sample.orientation))}")
        if sample.torque is not None:
            lines.append(f"    torque: {numbers(sample.torque)}")
        if sample.current is not None:
            lines.append(f"    current: {numbers(sample.current)}")
    return "\n".join(lines) + "\n"


def number(value):
    """A number that YAML reads as one."""
    text = f"{float(value):.12g}"
    return text if "." in text or "e" in text else text + ".0"


def numbers(values):
    return "[" + ", ".join(number(value) for value in values) + "]"
