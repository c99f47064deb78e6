"""A laboratory with a levitated rotor, in NumPy, written from doc/method.md: no joints, a tracker alone tells where the
rotor is. It shares no code with the package under test. Frames as in laboratory.py."""

import dataclasses

import numpy as np
from laboratory import CURVE, cross, quaternion_xyzw, rotation, rotation_vector


def axes_of(angles):
    """Unit vectors (n x 3) of polar angles and azimuths (n x 2)."""
    polar, azimuth = angles.T
    return np.stack([np.cos(polar) * np.cos(azimuth), np.cos(polar) * np.sin(azimuth), np.sin(polar)], axis=1)


def angles_of(axes):
    return np.stack([np.arcsin(np.clip(axes[:, 2], -1.0, 1.0)), np.arctan2(axes[:, 1], axes[:, 0])], axis=1)


@dataclasses.dataclass
class Sphere:
    """Poles and coils (polar, azimuth) as drawn; a unit is that plus errors, poles first. The torque curve is that of
    laboratory.py over `width` times the angle."""

    poles: np.ndarray  # m x 2
    polarity: np.ndarray
    coils: np.ndarray  # l x 2
    width: float

    def size(self):
        return 2 * (len(self.poles) + len(self.coils))

    def names(self):
        names = [f"pole_{i + 1}/{what}" for i in range(len(self.poles)) for what in ("polar", "azimuth")]
        return names + [f"coil_{j + 1}/{what}" for j in range(len(self.coils)) for what in ("polar", "azimuth")]

    def values(self, errors):
        return errors + np.concatenate([self.poles.ravel(), self.coils.ravel()])

    def torques(self, errors, R, coils):
        """Per ampere of one coil each, rotor frame: R n x 3 x 3, coils n."""
        m = 2 * len(self.poles)
        poles = axes_of(self.poles + errors[:m].reshape(-1, 2))
        axes = axes_of(self.coils + errors[m:].reshape(-1, 2))
        s = np.einsum("nji,nj->ni", R, axes[coils])
        crossed = cross(poles[None, :, :], s[:, None, :])
        sine = np.maximum(np.linalg.norm(crossed, axis=2), 1e-12)
        strength = self.polarity * CURVE(np.arctan2(sine, s @ poles.T) / self.width) / sine
        return np.einsum("nm,nmi->ni", strength, crossed)


def reaction_sphere():
    """8 poles at the corners of a cube, 20 coils at those of a dodecahedron, from above, each layer by azimuth."""
    golden = 0.5 * (1.0 + np.sqrt(5.0))
    signs = (-1.0, 1.0)
    cube = np.array([[x, y, z] for x in signs for y in signs for z in signs])
    others = [row for a in signs for b in signs
              for row in ([0.0, a / golden, b * golden], [a / golden, b * golden, 0.0], [a * golden, 0.0, b / golden])]

    def ordered(corners):
        angles = angles_of(corners / np.sqrt(3.0))
        angles[:, 1] = np.where(angles[:, 1] < -1e-9, angles[:, 1] + 2.0 * np.pi, angles[:, 1])
        order = np.lexsort((angles[:, 1].round(6), -angles[:, 0].round(6)))
        return angles[order], corners[order]

    poles, corners = ordered(cube)
    return Sphere(poles, np.sign(np.prod(corners, axis=1)), ordered(np.vstack([cube, others]))[0], 2.0)


@dataclasses.dataclass
class Laboratory:
    """Standard deviations; truth is drawn from them, and they are stated."""

    orientation: float = 5.77e-4  # [rad] per component, of a dwell
    torque: float = 2.89e-4  # [N m] per component
    registration: tuple = (0.0, 0.0, 0.0)  # [rad] tracker, marker, force/torque sensor


@dataclasses.dataclass
class Session:
    orientations: np.ndarray  # measured, one for each dwell
    dwell: np.ndarray  # of each torque
    coils: np.ndarray
    torques: np.ndarray  # measured


def random_orientations(count, tilt, rng):
    def turn(axis, half_width):
        return rotation(axis * rng.uniform(-half_width, half_width))

    x, y, z = np.eye(3)
    return np.array([turn(x, tilt) @ turn(y, tilt) @ turn(z, np.pi) for _ in range(count)])


def chosen_coils(unit, orientations, count, rng):
    """Of each pose as many coils, at random."""
    return np.array([rng.permutation(len(unit.coils))[:count] for _ in orientations]).ravel()


def measured_session(unit, errors, laboratory, orientations, coils, rng, ampere=2.0):
    tracker, marker, sensor = (rotation(rng.normal(0.0, stddev, 3)) for stddev in laboratory.registration)
    dwell = np.repeat(np.arange(len(orientations)), len(coils) // len(orientations))
    true = ampere * unit.torques(errors, orientations[dwell], coils)
    noise = [rotation(rng.normal(0.0, laboratory.orientation, 3)) for _ in orientations]
    measured = np.array([n @ tracker @ R @ marker for n, R in zip(noise, orientations)])
    return Session(measured, dwell, coils, true @ sensor.T + rng.normal(0.0, laboratory.torque, true.shape))


def write_samples(path, unit, laboratory, session, ampere=2.0):
    """The form of `loadSamples` without joints; samples of a dwell have its orientation."""
    lines = ["samples:"]

    def numbers(values):
        return "[" + ", ".join(repr(float(v)) for v in values) + "]"

    for dwell, coil, torque in zip(session.dwell, session.coils, session.torques):
        lines.append(f"  - orientation_xyzw: {numbers(quaternion_xyzw(session.orientations[dwell]))}")
        lines.append(f"    orientation_stddev: {float(laboratory.orientation)!r}")
        lines.append(f"    torque: {numbers(torque)}")
        lines.append(f"    torque_stddev: {float(laboratory.torque)!r}")
        lines.append(f"    current: {numbers(ampere * (np.arange(len(unit.coils)) == coil))}")
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")


def bound(unit, errors, laboratory, orientations, coils, ampere=2.0):
    """Covariance bound (Cramér-Rao) of the errors, at the truth. The true orientation of each dwell is unknown: it is
    eliminated from what the tracker, with its noise, and the torques say of it."""
    size, dwells = unit.size(), len(orientations)
    dwell = np.repeat(np.arange(dwells), len(coils) // dwells)

    def torques(x, R):
        """x: errors and the force/torque sensor's rotation; R: orientation of each dwell."""
        return ampere * unit.torques(x[:size], R[dwell], coils) @ rotation(x[size:]).T

    def derivative(of, count):
        step = 1e-6
        return np.stack([(of(step * e) - of(-step * e)) / (2.0 * step) for e in np.eye(count)], axis=-1)

    x = np.append(errors, np.zeros(3))
    by_x = derivative(lambda dx: torques(x + dx, orientations), size + 3) / laboratory.torque
    by_turn = derivative(lambda turn: torques(x, rotation(turn) @ orientations), 3) / laboratory.torque
    # What is measured of a dwell's orientation: e^n e^t (e^xi R) e^m, so ln(...) = n + t + xi + R m to first order.
    unknowns = size + 9  # errors, sensor, tracker, marker
    information = np.zeros((unknowns, unknowns))
    for k, R in enumerate(orientations):
        mine = dwell == k
        rows = np.zeros((3 * mine.sum() + 3, unknowns + 3))
        rows[:-3, : size + 3] = by_x[mine].reshape(-1, size + 3)
        rows[:-3, unknowns:] = by_turn[mine].reshape(-1, 3)
        rows[-3:, size + 3 :] = np.hstack([np.eye(3), R, np.eye(3)]) / laboratory.orientation
        N = rows.T @ rows
        information += N[:unknowns, :unknowns] - N[:unknowns, unknowns:] @ np.linalg.solve(
            N[unknowns:, unknowns:], N[unknowns:, :unknowns]
        )
    tracker, marker, sensor = laboratory.registration
    known = np.repeat([sensor, tracker, marker], 3)
    free = np.append(np.ones(size, bool), known > 0.0)
    information[size:, size:] += np.diag([1.0 / stddev**2 if stddev > 0.0 else 0.0 for stddev in known])
    return np.linalg.inv(information[np.ix_(free, free)])[:size, :size]
