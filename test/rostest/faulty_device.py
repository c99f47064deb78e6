"""A Modbus TCP device that misbehaves on demand, and an amplifier behind one that remembers when it had current."""

import contextlib
import socket
import struct
import threading
import time

from links import receive

REGISTERS = 256
HEADER = struct.Struct(">HHHB")  # transaction, protocol, length, unit
READ_HOLDING, READ_INPUT, WRITE = 3, 4, 16
RESET = struct.pack("ii", 1, 0)  # a link that is closed at once is reset
WRONG_BYTES = {"wrong protocol": 3, "wrong length": 5, "wrong unit": 6}  # of an answer's header
JUNK = b"\x55" * 4096
BYTE_PAUSE = 0.09  # [s] of an answer that dribbles: just below a response timeout of 0.1 s
SLOW = 0.09  # [s] of a slow answer


class FaultyDevice:
    """One unit with input and holding registers, whose answers are wrong in the way that `behaviour` names; requests
    are carried out all the same."""

    def __init__(self):
        self.behaviour = "good"
        self.registers = {READ_HOLDING: [0] * REGISTERS, READ_INPUT: [0] * REGISTERS}
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port = self._listener.getsockname()[1]
        self._lock = threading.Lock()
        threading.Thread(target=self._accept, daemon=True).start()

    def close(self):
        with contextlib.suppress(OSError):
            self._listener.shutdown(socket.SHUT_RDWR)
        self._listener.close()

    def written(self, address, values):
        """What a request to write does, under the lock."""
        self.registers[READ_HOLDING][address : address + len(values)] = values

    def measured(self):
        """Brings the input registers up to date, under the lock."""

    def _accept(self):
        while True:
            try:
                link, _ = self._listener.accept()
            except OSError:
                return
            link.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            threading.Thread(target=self._serve, args=(link,), daemon=True).start()

    def _serve(self, link):
        with link, contextlib.suppress(OSError, EOFError):
            while True:
                header = receive(link, HEADER.size)
                transaction, _, length, unit = HEADER.unpack(header)
                body = receive(link, length - 1)
                if self.behaviour == "cut":
                    return  # as if the request had never come
                with self._lock:
                    answer = self._carry_out(body)
                self._send(link, transaction, HEADER.pack(transaction, 0, len(answer) + 1, unit) + answer)

    def _carry_out(self, body):
        function, address, count = struct.unpack(">BHH", body[:5])
        if function == WRITE:
            self.written(address, list(struct.unpack(f">{count}H", body[6:])))
            return body[:5]
        self.measured()
        values = self.registers[function][address : address + count]
        return struct.pack(f">BB{count}H", function, 2 * count, *values)

    def _send(self, link, transaction, answer):
        how = self.behaviour
        if how == "silence":
            return
        if how == "reset":
            link.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, RESET)
            raise EOFError
        if how == "wrong id":
            answer = struct.pack(">H", (transaction + 1) & 0xFFFF) + answer[2:]
        if how in WRONG_BYTES:
            place = WRONG_BYTES[how]
            answer = answer[:place] + bytes([answer[place] ^ 1]) + answer[place + 1 :]
        if how == "slow":
            time.sleep(SLOW)
        if how == "dribble":
            for place in range(len(answer)):
                time.sleep(BYTE_PAUSE)
                link.sendall(answer[place : place + 1])
            return
        link.sendall(answer)
        while how == "endless":
            link.sendall(JUNK)


class FaultyAmplifier(FaultyDevice):
    """The amplifier of config/coil_driver.yaml. Two are looked at together: one that has current while its registers
    say so, and one with a watchdog of its own, whose currents it measures."""

    COILS = 24
    ENABLE, HEARTBEAT = 100, 101

    def __init__(self):
        super().__init__()
        self.watchdog = 0.5  # [s]
        self._stuck = False
        self.stray = None  # words of all coils as long as its watchdog holds, by the time [s]; None: what was set
        self._beat_at = -1e9
        self._history = []  # (begin of the interval, whether registers say current, last heartbeat, currents)

    def written(self, address, values):
        now = time.monotonic()
        holding = self.registers[READ_HOLDING]
        if address == self.HEARTBEAT and values[0] != holding[self.HEARTBEAT]:
            self._beat_at = now
        if not self._stuck or address == self.HEARTBEAT:
            super().written(address, values)
        setpoints = tuple(holding[: self.COILS])
        is_on = holding[self.ENABLE] == 1 and any(setpoints)
        self._history.append((now, is_on, self._beat_at, setpoints))

    def measured(self):
        holding = self.registers[READ_HOLDING]
        is_alive = time.monotonic() - self._beat_at <= self.watchdog
        on = holding[self.ENABLE] == 1 and is_alive
        self.registers[READ_INPUT][: self.COILS] = holding[: self.COILS] if on else [0] * self.COILS
        if self.stray is not None:
            now = time.monotonic()
            word = self.stray(now) & 0xFFFF if is_alive else 0
            self.registers[READ_INPUT][: self.COILS] = [word] * self.COILS
            self._history.append((now, word != 0, self._beat_at, (0,) * self.COILS))

    def stick(self):
        """From now on all is acknowledged, and nothing applied but the heartbeat. Returns when."""
        with self._lock:
            self._stuck = True
            return time.monotonic()

    def obey(self):
        """From now on all is applied again."""
        with self._lock:
            self._stuck = False

    def _intervals(self):
        with self._lock:
            history = list(self._history)
        ends = [begin for begin, *_ in history[1:]] + [time.monotonic()]
        return [(begin, end, *rest) for (begin, *rest), end in zip(history, ends)]

    def is_on(self):
        with self._lock:
            return bool(self._history) and self._history[-1][1]

    def on_until(self, begin):
        """How long after `begin` current was on last [s], by the registers and with the watchdog."""
        by_registers = watched = 0.0
        for first, last, is_on, beat_at, _ in self._intervals():
            if is_on and last > begin:
                by_registers = last - begin
                if beat_at + self.watchdog > max(begin, first):
                    watched = max(watched, min(last, beat_at + self.watchdog) - begin)
        return by_registers, watched

    def words_of(self, coil):
        """All words that a coil, counted from 1, was ever given."""
        return {setpoints[coil - 1] for *_, setpoints in self._intervals()}
