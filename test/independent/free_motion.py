"""A free rotor in NumPy, written from doc/method.md: rigid-body rotation under coils, gravity and friction, recorded by
streams with noise and delays. It shares no code with the package under test.

Frames: R maps rotor to stator. SI units. A stamp is later than what it belongs to by the delay of its stream.
"""

import dataclasses
import math

import laboratory as lab
import numpy as np


@dataclasses.dataclass
class Machine:
    """What moves, and how it is recorded."""

    inertia: np.ndarray = dataclasses.field(
        default_factory=lambda: np.array([[0.75e-3, 2e-5, -1.5e-5], [2e-5, 0.66e-3, 1e-5], [-1.5e-5, 1e-5, 1.42e-3]])
    )
    unbalance: tuple = (1.2e-3, -0.8e-3, 1.5e-3)  # [N m]
    viscous: float = 6e-4  # [N m s/rad]
    coulomb: float = 4e-4  # [N m]
    friction_speed: float = 0.05  # [rad/s]
    drag: float = 0.0  # [N m s^2/rad^2] of air: grows with the square of the speed
    spin_viscous: float = 0.0  # [N m s/rad] more about the rotor's axis z
    strength: float = 1.0  # of all torques
    curve_stretch: float = 0.0  # the torque at an angle is that of the drawing at angle / (1 + stretch)
    pole_gains: np.ndarray = None  # errors of strength
    coil_gains: np.ndarray = None
    step: float = 5e-3  # [s] between setpoints
    lag: float = 2e-3  # [s] of the amplifier
    limit: float = 8.0  # [A] of the sum
    coil_limit: float = math.inf  # [A] of the setpoint of each coil
    chatter: float = 0.0  # [A] standard deviation of what a noisy controller adds to the setpoint of each coil, at every step
    excitation: float = 0.35  # [A] peak of the multisine of a coil
    push: tuple = None  # (begin, end [s], torque [N m]): a hand touches the rotor


@dataclasses.dataclass
class Streams:
    joint_rate: float = 1000.0
    current_rate: float = 1000.0
    tracker_rate: float = 240.0
    joint_stddev: float = 2e-5  # [rad]
    current_stddev: float = 1e-3  # [A]
    tracker_stddev: float = 5.8e-4  # [rad] per component
    tracker_fade: float = 0.0  # [s] within which an error of the tracker fades: 0 is white noise
    current_delay: float = 0.0  # [s]
    tracker_delay: float = 4e-3  # [s]
    joint_phase: float = 0.0  # [s] of the first stamp
    joint_skews: tuple = (0.0, 0.0, 0.0)  # [s] by how much later than its stamp each joint is read
    current_phase: float = 0.0
    has_commands: bool = False
    command_delay: float = 1.5e-3  # [s] from the stamp of a command to its effect
    command_jitter: float = 0.0  # [s] standard deviation of the same
    lost: float = 0.0  # share of the messages that got lost, of commands none


def rotations(vectors):
    """exp of many rotation vectors, n x 3."""
    angle = np.linalg.norm(vectors, axis=1)[:, None, None]
    K = np.zeros((len(vectors), 3, 3))
    K[:, 0, 1], K[:, 0, 2], K[:, 1, 2] = -vectors[:, 2], vectors[:, 1], -vectors[:, 0]
    K -= K.transpose(0, 2, 1)
    safe = np.maximum(angle, 1e-12)
    return np.eye(3) + np.sin(angle) / safe * K + (1.0 - np.cos(angle)) / safe**2 * (K @ K)


def _logs(R):
    """log of many rotations below pi."""
    v = 0.5 * np.stack([R[:, 2, 1] - R[:, 1, 2], R[:, 0, 2] - R[:, 2, 0], R[:, 1, 0] - R[:, 0, 1]], axis=1)
    sine = np.linalg.norm(v, axis=1)
    angle = np.arctan2(sine, 0.5 * (np.trace(R, axis1=1, axis2=2) - 1.0))
    return v * np.where(sine < 1e-12, 1.0, angle / np.maximum(sine, 1e-12))[:, None]


def joint_angles(unit, errors, R):
    """Readings at which the joints make these orientations, without jumps of the spin; Newton's method."""
    axes = np.stack([lab.chart_axis(unit.bases[k], *errors[3 * k + 1 : 3 * k + 3]) for k in range(3)])
    q = np.stack([np.arctan2(-R[:, 1, 2], R[:, 2, 2]), np.arcsin(R[:, 0, 2]), np.unwrap(np.arctan2(-R[:, 0, 1], R[:, 0, 0]))], axis=1)
    for _ in range(4):  # from some hundredths of a radian, each squares what is left
        A1 = rotations(q[:, :1] * axes[0])
        A2 = A1 @ rotations(q[:, 1:2] * axes[1])
        made = A2 @ rotations(q[:, 2:] * axes[2])
        columns = np.stack([np.broadcast_to(axes[0], (len(q), 3)), A1 @ axes[1], A2 @ axes[2]], axis=2)
        q = q + np.linalg.solve(columns, _logs(R @ made.transpose(0, 2, 1))[:, :, None])[:, :, 0]
    return q - errors[[0, 3, 6]]


def _quaternion_matrix(p):
    w, x, y, z = p.tolist()
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


class Coils:
    """Torque of all pairs, stator frame, per ampere of each coil."""

    def __init__(self, unit, errors, machine=None):
        m = len(unit.poles)
        poles = unit.poles + errors[9 : 9 + 2 * m].reshape(-1, 2)
        coils = unit.coils + errors[9 + 2 * m :].reshape(-1, 2)
        self.poles = np.stack([lab.axis_of(*pole) for pole in poles])
        self.coils = np.stack([lab.axis_of(*coil) for coil in coils])
        self.stretch = 1.0
        self.strength = np.repeat(unit.polarity[:, None], len(coils), axis=1)
        if machine is not None:
            self.stretch += machine.curve_stretch
            self.strength = self.strength * machine.strength
            if machine.pole_gains is not None:
                self.strength = self.strength * (1.0 + machine.pole_gains)[:, None]
            if machine.coil_gains is not None:
                self.strength = self.strength * (1.0 + machine.coil_gains)
        # h = f / sin psi is smooth in kappa = cos psi: a fine table of it costs least.
        end = lab.SUPPORT_END * lab.DEGREE * self.stretch
        self._kappa = np.linspace(np.cos(end), 1.0, 200_001)
        sine = np.sqrt(np.maximum(1.0 - self._kappa**2, 1e-20))
        self._h = lab.CURVE(np.arctan2(sine, self._kappa) / self.stretch) / sine

    def pairs(self, R):
        """Poles in the stator frame, and h of T = I h (r x s) for each pole and coil."""
        p = self.poles @ R.T
        h = np.interp(p @ self.coils.T, self._kappa, self._h, left=0.0)
        return p, self.strength * h

    def torque(self, R, current):
        p, h = self.pairs(R)
        M = (p.T @ ((h * current) @ self.coils)).tolist()  # of numbers, which costs less than of small arrays
        return np.array([M[1][2] - M[2][1], M[2][0] - M[0][2], M[0][1] - M[1][0]])

    def per_ampere(self, R):
        p, h = self.pairs(R)
        return np.cross((h.T @ p), self.coils).T


class Reference:
    """Sums of sines: spin over +-pi, tilt up to 0.38 rad; multisines of coils."""

    def __init__(self, machine, coils, rng, tilt=0.38):
        self.frequency = rng.uniform([[0.1], [0.1], [0.05]], [[0.4], [0.4], [0.2]], (3, 3)) * 2 * np.pi
        self.phase = rng.uniform(0, 2 * np.pi, (3, 3))
        self.amplitude = np.array([[0.5], [0.5], [0.6]]) * rng.dirichlet([4, 4, 4], 3) * 2.0
        self.scale = np.array([0.75 * tilt / np.sqrt(2) * 1.4, 0.75 * tilt / np.sqrt(2) * 1.4, np.pi])
        self.coil_frequency = rng.uniform(0.3, 4.0, (coils, 6)) * 2 * np.pi
        self.coil_phase = rng.uniform(0, 2 * np.pi, (coils, 6))
        self.excitation = machine.excitation

    def angles(self, t):
        a = self.amplitude / self.amplitude.sum(axis=1, keepdims=True)
        return self.scale * (a * np.sin(self.frequency * t + self.phase)).sum(axis=1)

    def orientation(self, t):
        (a, b, c), (x, y, z) = (f(self.angles(t)).tolist() for f in (np.cos, np.sin))
        return np.array([[b * c, -b * z, y], [a * z + x * y * c, a * c - x * y * z, -x * b], [x * z - a * y * c, x * c + a * y * z, a * b]])

    def currents(self, t):
        return self.excitation / np.sqrt(6) * np.sqrt(2) * np.sin(self.coil_frequency * t + self.coil_phase).sum(axis=1)


@dataclasses.dataclass
class Motion:
    time: np.ndarray  # [s], every millisecond
    orientation: np.ndarray  # n x 3 x 3
    setpoint: np.ndarray  # n x l: from this time on
    current: np.ndarray  # n x l: at this time
    lag: float


class _Rotor:
    """Rates of a free rotor: quaternion p (w x y z), angular momentum L of the stator frame."""

    def __init__(self, unit, errors, machine):
        self.machine = machine
        self.coils = Coils(unit, errors, machine)
        self.inverse = np.linalg.inv(machine.inertia)
        self.centre = np.array(machine.unbalance)

    def rate(self, R, L):
        return R @ (self.inverse @ (R.T @ L))

    def rates(self, t, p, L, current):
        # Of single numbers what is small: an operation on an array of three takes as long as one of a hundred.
        machine = self.machine
        p = p / math.sqrt(p @ p)
        R = _quaternion_matrix(p)
        w = self.rate(R, L)
        x, y, z = w.tolist()
        square = x * x + y * y + z * z
        resists = machine.viscous + machine.coulomb / math.sqrt(square + machine.friction_speed**2) + machine.drag * math.sqrt(square)
        a = R @ self.centre
        torque = self.coils.torque(R, current) - resists * w
        torque[0] -= a[1]
        torque[1] += a[0]
        if machine.spin_viscous:
            torque -= machine.spin_viscous * (R[:, 2] @ w) * R[:, 2]
        if machine.push is not None and machine.push[0] <= t < machine.push[1]:
            torque += machine.push[2]
        s, a, b, c = (0.5 * p).tolist()
        turn = (-x * a - y * b - z * c, x * s + y * c - z * b, y * s + z * a - x * c, z * s + x * b - y * a)
        return np.array(turn), torque

    def advance(self, t, p, L, h, begin, middle, end):
        """After h, with the currents at its begin, middle and end."""
        k1p, k1L = self.rates(t, p, L, begin)
        k2p, k2L = self.rates(t + h / 2, p + h / 2 * k1p, L + h / 2 * k1L, middle)
        k3p, k3L = self.rates(t + h / 2, p + h / 2 * k2p, L + h / 2 * k2L, middle)
        k4p, k4L = self.rates(t + h, p + h * k3p, L + h * k3L, end)
        p = p + h / 6 * (k1p + 2 * k2p + 2 * k3p + k4p)
        return p / np.sqrt(p @ p), L + h / 6 * (k1L + 2 * k2L + 2 * k3L + k4L)


class _Controller:
    """Computed torque with the drawing alone, and the multisines in the null space of its torques."""

    def __init__(self, unit, machine, reference, inertia):
        self.coils, self.machine, self.reference = Coils(unit, np.zeros(unit.size())), machine, reference
        self.inertia = np.diag(inertia)

    def setpoint(self, t, R, w):
        target, ahead, behind = (self.reference.orientation(t + d) for d in (0.0, 1e-3, -1e-3))
        rate = lab.rotation_vector(ahead @ behind.T) / 2e-3
        turn = (lab.rotation_vector(ahead @ target.T) - lab.rotation_vector(target @ behind.T)) / 1e-6
        wanted = turn + 20.0 * (rate - w) + 100.0 * lab.rotation_vector(target @ R.T)
        Q = self.coils.per_ampere(R)
        pseudo = Q.T @ np.linalg.inv(Q @ Q.T)
        wish = self.reference.currents(t)
        setpoint = pseudo @ (R @ self.inertia @ R.T @ wanted) + wish - pseudo @ (Q @ wish)
        return setpoint * min(1.0, self.machine.limit / np.abs(setpoint).sum())


def simulate(unit, errors, machine, duration, seed, nominal_inertia=(0.7e-3, 0.7e-3, 1.3e-3)):
    """Runge-Kutta of fourth order at a millisecond."""
    reference = Reference(machine, len(unit.coils), np.random.default_rng(seed))
    rotor, controller = _Rotor(unit, errors, machine), _Controller(unit, machine, reference, nominal_inertia)
    h, steps, coils = 1e-3, int(round(duration * 1000)), len(unit.coils)
    per_setpoint = int(round(machine.step / h))
    R = reference.orientation(0.0)
    p = np.roll(lab.quaternion_xyzw(R), 1)
    L = R @ machine.inertia @ R.T @ (lab.rotation_vector(reference.orientation(1e-4) @ R.T) / 1e-4)
    setpoint, current = np.zeros(coils), np.zeros(coils)
    decay = np.exp(-h / machine.lag * np.array([0.5, 1.0])) if machine.lag > 0 else np.zeros(2)
    out = Motion(np.arange(steps) * h, np.zeros((steps, 3, 3)), np.zeros((steps, coils)), np.zeros((steps, coils)), machine.lag)
    noise = np.random.default_rng([seed, 2])
    for n in range(steps):
        R = _quaternion_matrix(p)
        if n % per_setpoint == 0:
            wish = controller.setpoint(n * h, R, rotor.rate(R, L)) + machine.chatter * noise.normal(size=coils)
            setpoint = np.clip(wish, -machine.coil_limit, machine.coil_limit)
        begin = current if machine.lag > 0 else setpoint
        middle, end = (setpoint + (begin - setpoint) * share for share in decay)
        out.orientation[n], out.setpoint[n], out.current[n] = R, setpoint, begin
        p, L = rotor.advance(n * h, p, L, h, begin, middle, end)
        current = end
    return out


def _at(motion, t):
    """Orientation between the steps: cubic in the rotation vector."""
    n = np.clip(np.floor(t / 1e-3 + 1e-9).astype(int), 1, len(motion.time) - 3)
    s = (t - motion.time[n]) / 1e-3
    base = motion.orientation[n]
    back = base.transpose(0, 2, 1)
    a, b, c = (_logs(motion.orientation[n + k] @ back) for k in (-1, 1, 2))
    w = np.stack([-s * (s - 1) * (s - 2) / 6, -s * (s + 1) * (s - 2) / 2, s * (s + 1) * (s - 1) / 6])
    return rotations(w[0][:, None] * a + w[1][:, None] * b + w[2][:, None] * c) @ base


def _fading_noise(rng, count, stddev, fade, rate):
    """Of which neighbours have a part in common; rows of three."""
    noise = rng.normal(0.0, stddev, (count, 3))
    kept = np.exp(-1.0 / (fade * rate)) if fade > 0.0 else 0.0
    for n in range(1, count if kept > 0.0 else 0):
        noise[n] = kept * noise[n - 1] + np.sqrt(1.0 - kept**2) * noise[n]
    return noise


def _current_at(motion, t):
    n = np.clip(np.floor(t / 1e-3 + 1e-9).astype(int), 0, len(motion.time) - 1)
    if motion.lag <= 0:
        return motion.setpoint[n]
    share = np.exp(-(t - motion.time[n]) / motion.lag)[:, None]
    return motion.setpoint[n] + (motion.current[n] - motion.setpoint[n]) * share


def record(unit, errors, motion, streams, seed):
    """{joints: (stamps, readings), currents: ..., orientations: (stamps, n x 3 x 3)}, and commands where there are"""
    rng = np.random.default_rng(seed)
    first, last = 0.005, motion.time[-1] - 0.005

    def stamps(rate, phase=0.0):
        return np.arange(first + phase, last, 1.0 / rate)

    t = stamps(streams.joint_rate, streams.joint_phase)
    read = {skew: joint_angles(unit, errors, _at(motion, t + skew)) for skew in set(streams.joint_skews)}
    q = np.stack([read[skew][:, k] for k, skew in enumerate(streams.joint_skews)], axis=1)
    result = {"joints": (t, q + rng.normal(0.0, streams.joint_stddev, q.shape) if streams.joint_stddev else q)}
    t = stamps(streams.current_rate, streams.current_phase)
    I = _current_at(motion, t)
    I = I + rng.normal(0.0, streams.current_stddev, I.shape) if streams.current_stddev else I
    result["currents"] = (t + streams.current_delay, I)
    if streams.has_commands:
        changes = np.any(np.diff(motion.setpoint, axis=0) != 0.0, axis=1)
        n = np.append(0, 1 + np.flatnonzero(changes))
        t = motion.time[n] - streams.command_delay - rng.normal(0.0, 1.0, len(n)) * streams.command_jitter
        result["commands"] = (t + streams.current_delay, motion.setpoint[n])
    t = stamps(streams.tracker_rate)
    R = _at(motion, t)
    if streams.tracker_stddev:
        R = rotations(_fading_noise(rng, len(t), streams.tracker_stddev, streams.tracker_fade, streams.tracker_rate)) @ R
    result["orientations"] = (t + streams.tracker_delay, R)
    return _without_lost(result, streams.lost, np.random.default_rng([seed, 1]))


def _without_lost(recording, share, rng):
    def arrived(key, stamps, values):
        arrives = rng.random(len(stamps)) >= (0.0 if key == "commands" else share)
        return stamps[arrives], values[arrives]

    return {key: arrived(key, *stream) for key, stream in recording.items()}


def write_text(path, recording):
    """One measurement a line: J, C, U (commands) or O, stamp [ns], values (orientations as x y z w)."""
    rows = []
    for letter, key in (("J", "joints"), ("U", "commands"), ("C", "currents"), ("O", "orientations")):
        if key not in recording:
            continue
        for t, values in zip(*recording[key]):
            if letter == "O":
                values = lab.quaternion_xyzw(values)
            rows.append((t, f"{letter} {int(round((t + 100.0) * 1e9))} " + " ".join(f"{v:.12g}" for v in values)))
    rows.sort(key=lambda row: row[0])
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(row for _, row in rows) + "\n")
