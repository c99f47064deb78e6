"""A calibration laboratory in NumPy, written from doc/method.md. It shares no code with the package under test.

Frames: R maps rotor to stator. SI units. A session is a list of dwells; each dwell has one reading of the joints,
whose error all its measurements share, an orientation, and torques of coils that are excited in turn.
"""

import dataclasses
import math

import numpy as np

DEGREE = np.pi / 180.0
FIRST, SECOND = np.array([1, 2, 0]), np.array([2, 0, 1])  # components in a vector product
COEFFICIENTS = (-5.40e-3, 5.18e-2, -3.73e-6, -4.2e-4, 2.39e-5, -5.07e-7, 3.78e-9)  # psi in degrees
BLEND_START, SUPPORT_BEGIN, SUPPORT_END = 2.0, 28.0, 32.0  # [deg]


def skew(v):
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def rotation(v):
    """exp of a rotation vector [rad]."""
    x, y, z = (float(one) for one in v)  # single numbers cost less than small arrays
    angle = math.sqrt(x * x + y * y + z * z)
    if angle < 1e-12:
        return np.eye(3) + skew(v)
    x, y, z = x / angle, y / angle, z / angle
    c, s = math.cos(angle), math.sin(angle)
    w = 1.0 - c
    return np.array([
        [c + w * x * x, w * x * y - s * z, w * x * z + s * y],
        [w * x * y + s * z, c + w * y * y, w * y * z - s * x],
        [w * x * z - s * y, w * y * z + s * x, c + w * z * z],
    ])  # fmt: skip


def cross(a, b):
    """Of vectors along the last axis. numpy's own takes five times as long for few of them."""
    return a[..., FIRST] * b[..., SECOND] - a[..., SECOND] * b[..., FIRST]


def rotation_vector(R):
    """log of a rotation, for angles below pi [rad]."""
    v = 0.5 * np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
    sine = np.linalg.norm(v)
    angle = np.arctan2(sine, 0.5 * (np.trace(R) - 1.0))
    return v if sine < 1e-12 else v * (angle / sine)


def quaternion_xyzw(R):
    v = rotation_vector(R)
    angle = np.linalg.norm(v)
    axis = v / angle if angle > 0.0 else np.zeros(3)
    return np.append(np.sin(0.5 * angle) * axis, np.cos(0.5 * angle))


class TorqueCurve:
    """f(psi) [N m/A]: odd cubic, polynomial, cubic Hermite to zero, zero; psi in rad."""

    def __init__(self):
        self._polynomial = np.polynomial.Polynomial(COEFFICIENTS)
        slope = self._polynomial.deriv()
        b = BLEND_START
        # k1 b + k3 b^3 = f(b) and k1 + 3 k3 b^2 = f'(b), in degrees.
        value, derivative = self._polynomial(b), slope(b)
        self._k3 = (derivative - value / b) / (2.0 * b * b)
        self._k1 = value / b - self._k3 * b * b
        self._edge = self._polynomial(SUPPORT_BEGIN), slope(SUPPORT_BEGIN)

    def __call__(self, psi):
        x = np.asarray(psi) / DEGREE
        width = SUPPORT_END - SUPPORT_BEGIN
        t = np.clip((x - SUPPORT_BEGIN) / width, 0.0, 1.0)
        value, slope = self._edge
        hermite = (1.0 + 2.0 * t) * (1.0 - t) ** 2 * value + t * (1.0 - t) ** 2 * width * slope
        result = np.where(x < SUPPORT_BEGIN, self._polynomial(np.minimum(x, SUPPORT_BEGIN)), hermite)
        return np.where(x < BLEND_START, self._k1 * x + self._k3 * x**3, result)


CURVE = TorqueCurve()


def axis_of(polar, azimuth):
    across = math.cos(polar)
    return np.array([across * math.cos(azimuth), across * math.sin(azimuth), math.sin(polar)])


def chart_axis(base, u, v):
    """Normal coordinates around an axis: e_u is the part across it of the coordinate axis that follows its largest
    component, cyclically."""
    k = int(np.argmax(np.abs(base)))
    e_u = np.eye(3)[(k + 1) % 3]
    e_u = e_u - base * (base @ e_u)
    e_u = e_u / np.linalg.norm(e_u)
    e_v = cross(base, e_u)
    rho = np.hypot(u, v)
    if rho < 1e-12:
        return base + u * e_u + v * e_v
    return np.cos(rho) * base + np.sin(rho) * (u * e_u + v * e_v) / rho


@dataclasses.dataclass
class Unit:
    """A unit: joints (offset, u, v), poles and coils (polar, azimuth), as errors added to a drawing."""

    bases: np.ndarray  # 3x3, row k: nominal axis of joint k
    poles: np.ndarray  # m x 2
    polarity: np.ndarray
    coils: np.ndarray  # l x 2

    def size(self):
        return 9 + 2 * len(self.poles) + 2 * len(self.coils)

    def names(self):
        names = [f"joint_{k + 1}/{what}" for k in range(3) for what in ("offset", "axis_u", "axis_v")]
        names += [f"pole_{i + 1}/{what}" for i in range(len(self.poles)) for what in ("polar", "azimuth")]
        return names + [f"coil_{j + 1}/{what}" for j in range(len(self.coils)) for what in ("polar", "azimuth")]

    def values(self, errors):
        """As they are reported: angles of poles and coils themselves, joints as deviations."""
        return errors + np.concatenate([np.zeros(9), self.poles.ravel(), self.coils.ravel()])

    def orientation(self, errors, q):
        R = np.eye(3)
        for k in range(3):
            offset, u, v = errors[3 * k : 3 * k + 3]
            R = R @ rotation(chart_axis(self.bases[k], u, v) * (q[k] + offset))
        return R

    def torque(self, errors, R, current):
        """On the rotor, rotor frame; current: {coil: ampere}."""
        m = len(self.poles)
        poles = self.poles + errors[9 : 9 + 2 * m].reshape(-1, 2)
        coils = self.coils + errors[9 + 2 * m :].reshape(-1, 2)
        r = np.stack([axis_of(*pole) for pole in poles])
        total = np.zeros(3)
        for coil, ampere in current.items():
            s = R.T @ axis_of(*coils[coil])
            crossed = cross(r, s)
            sine = np.maximum(np.linalg.norm(crossed, axis=1), 1e-12)
            f = CURVE(np.arctan2(sine, r @ s))
            total += ampere * ((self.polarity * f / sine) @ crossed)
        return total


def paper_unit():
    """8 poles, 24 coils in two layers."""
    poles = np.array([[0.0, i * np.pi / 4.0] for i in range(8)])
    coils = np.array([[p, j * np.pi / 6.0] for p in (0.2618, -0.2618) for j in range(12)])
    return Unit(np.eye(3), poles, np.array([1.0, -1.0] * 4), coils)


@dataclasses.dataclass
class Laboratory:
    """What the sensors add. Standard deviations; truth is drawn from them, and they are stated."""

    orientation: float = 2e-4  # [rad] per component
    torque: float = 3e-4  # [N m] per component, of the mean under current
    zero_current: float = 0.0  # [N m] of the zero-current mean that is taken off: shared in a dwell
    joint: float = 0.0  # [rad] of the reading: shared in a dwell
    encoder_bits: int = 0  # 0: no quantisation
    registration: tuple = (0.0, 0.0, 0.0)  # [rad] tracker, marker, force/torque sensor
    bias_drift: float = 0.0  # [N m] over a dwell, after the zero-current part

    def reading_stddev(self):
        step = 2.0 * np.pi / 2**self.encoder_bits if self.encoder_bits else 0.0
        return np.hypot(self.joint, step / np.sqrt(12.0))


@dataclasses.dataclass
class Dwell:
    reading: np.ndarray
    orientation: np.ndarray = None  # measured R
    torques: list = dataclasses.field(default_factory=list)  # ({coil: ampere}, measured torque)
    held_out: bool = False


def coils_in_reach(unit, q, count):
    """Those that tell most at a pose: nearest to 12 degrees from a pole as drawn."""
    R = unit.orientation(np.zeros(unit.size()), q)
    s = np.stack([R.T @ axis_of(*coil) for coil in unit.coils])
    r = np.stack([axis_of(*pole) for pole in unit.poles])
    psi = np.arccos(np.clip(s @ r.T, -1.0, 1.0)) / DEGREE
    reach = np.abs(psi - 12.0).min(axis=1)
    return np.argsort(reach)[:count]


def random_poses(count, tilt, rng):
    return [np.array([rng.uniform(-tilt, tilt), rng.uniform(-tilt, tilt), rng.uniform(-np.pi, np.pi)]) for _ in range(count)]


def measured_session(unit, errors, laboratory, poses, coils_per_pose, rng, ampere=2.0):
    """Returns dwells and the registrations drawn."""
    registration = [rng.normal(0.0, stddev, 3) for stddev in laboratory.registration]
    X_tracker, X_marker, X_sensor = (rotation(v) for v in registration)
    step = 2.0 * np.pi / 2**laboratory.encoder_bits if laboratory.encoder_bits else 0.0
    dwells = []
    for q in poses:
        reading = q + rng.normal(0.0, laboratory.joint, 3) if laboratory.joint else q.copy()
        if step:
            reading = np.round(reading / step) * step
        R = unit.orientation(errors, q)
        noise = rotation(rng.normal(0.0, laboratory.orientation, 3))
        dwell = Dwell(reading, noise @ X_tracker @ R @ X_marker)
        shared = rng.normal(0.0, laboratory.zero_current, 3) if laboratory.zero_current else np.zeros(3)
        drift = rng.normal(0.0, laboratory.bias_drift, 3) if laboratory.bias_drift else np.zeros(3)
        coils = coils_in_reach(unit, q, coils_per_pose)
        for n, coil in enumerate(coils):
            current = {int(coil): ampere}
            torque = X_sensor @ unit.torque(errors, R, current) + shared + drift * (n + 1) / len(coils)
            dwell.torques.append((current, torque + rng.normal(0.0, laboratory.torque, 3)))
        dwells.append(dwell)
    return dwells, registration


def stated_torque_stddev(laboratory):
    return float(np.hypot(laboratory.torque, laboratory.zero_current))


def write_samples(path, unit, laboratory, dwells, validation_every=0):
    """The form of `loadSamples`. Every so manieth dwell is held out."""
    lines = ["samples:"]
    joint_stddev = laboratory.reading_stddev()

    def numbers(values):
        return "[" + ", ".join(repr(float(v)) for v in values) + "]"

    for n, dwell in enumerate(dwells):
        held_out = dwell.held_out or validation_every and n % validation_every == validation_every - 1
        common = [f"  - joint_position: {numbers(dwell.reading)}", f"    joint_stddev: {numbers([joint_stddev] * 3)}"]
        if held_out:
            common.append("    validation: true")
        if dwell.orientation is not None:
            lines += common
            lines.append(f"    orientation_xyzw: {numbers(quaternion_xyzw(dwell.orientation))}")
            lines.append(f"    orientation_stddev: {float(laboratory.orientation)!r}")
        for current, torque in dwell.torques:
            all_currents = np.zeros(len(unit.coils))
            for coil, ampere in current.items():
                all_currents[coil] = ampere
            lines += common
            lines.append(f"    torque: {numbers(torque)}")
            lines.append(f"    torque_stddev: {float(stated_torque_stddev(laboratory))!r}")
            if laboratory.zero_current:
                lines.append(f"    torque_shared_stddev: {float(laboratory.zero_current)!r}")
            lines.append(f"    current: {numbers(all_currents)}")
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")


def predicted(unit, x, dwell):
    """Stacked prediction of a dwell at x = (errors, registrations, errors of the reading, bias, its drift)."""
    size = unit.size()
    errors, tracker, marker, sensor = x[:size], x[size : size + 3], x[size + 3 : size + 6], x[size + 6 : size + 9]
    joints, bias, drift = x[size + 9 : size + 12], x[size + 12 : size + 15], x[size + 15 : size + 18]
    R = unit.orientation(errors, dwell.reading - joints)
    rows = []
    if dwell.orientation is not None:
        predicted = rotation(tracker) @ R @ rotation(marker)
        rows.append(-rotation_vector(dwell.orientation @ predicted.T))
    for n, (current, _) in enumerate(dwell.torques):
        drifted = bias + drift * (n + 1) / len(dwell.torques)
        rows.append(rotation(sensor) @ unit.torque(errors, R, current) + drifted)
    return np.concatenate(rows)


def bound(unit, errors, laboratory, dwells, registered=None):
    """Covariance bound (Gauss-Markov) of the errors with all latent errors, dense: nothing is eliminated cleverly.

    `registered`: standard deviations of the registrations that the estimator knows; those of the laboratory.
    """
    size = unit.size()
    stddevs = laboratory.registration if registered is None else registered
    shared = size + 9
    information = np.zeros((shared, shared))
    latent = np.repeat([laboratory.reading_stddev(), laboratory.zero_current, laboratory.bias_drift], 3)
    count = shared + len(latent)
    for dwell in dwells:
        x = np.concatenate([errors, np.zeros(count - size)])
        columns = []
        for p in range(count):
            step = np.zeros(count)
            step[p] = 1e-6
            columns.append((predicted(unit, x + step, dwell) - predicted(unit, x - step, dwell)) / 2e-6)
        J = np.stack(columns, axis=1)
        variances = [laboratory.orientation**2] * 3 if dwell.orientation is not None else []
        variances += [laboratory.torque**2] * (3 * len(dwell.torques))
        V = np.diag(variances) + J[:, shared:] @ np.diag(latent**2) @ J[:, shared:].T
        information += J[:, :shared].T @ np.linalg.solve(V, J[:, :shared])
    known = np.repeat(np.asarray(stddevs), 3)
    free = np.concatenate([np.ones(size, bool), known > 0.0])
    information[size:, size:] += np.diag(np.divide(1.0, known**2, out=np.zeros_like(known), where=known > 0.0))
    covariance = np.linalg.inv(information[np.ix_(free, free)])
    return covariance[:size, :size]
