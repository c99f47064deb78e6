"""Modbus devices by an independent implementation (pymodbus), over TCP or a pair of serial lines."""

import os
import socket
import subprocess
import tempfile
import threading

from calibration_client import wait_for
from links import serve_each
from pymodbus.datastore import ModbusSequentialDataBlock, ModbusServerContext, ModbusSlaveContext
from pymodbus_servers import serve_serial, serve_tcp

REGISTERS = 200


class Block(ModbusSequentialDataBlock):
    """Registers that remember every request which wrote them."""

    def __init__(self):
        super().__init__(0, [0] * REGISTERS)
        self.history = []

    def setValues(self, address, values):  # noqa: N802, pylint: disable=invalid-name
        self.history.append((address, list(values)))
        super().setValues(address, values)


class Setpoints(Block):
    """Registers of an amplifier without inductance: what is set is measured at once."""

    def __init__(self, measured, coils):
        super().__init__()
        self.measured = measured
        self._coils = coils
        self.are_applied = True
        self._lock = threading.Lock()

    def setValues(self, address, values):  # noqa: N802, pylint: disable=invalid-name
        super().setValues(address, values)
        with self._lock:
            if self.are_applied and address < self._coils:
                self.measured.setValues(address, values)

    def stick(self, coil, word):
        """From now on nothing is applied, and this is measured."""
        with self._lock:
            self.are_applied = False
            self.measured.setValues(coil - 1, [word])


class Registers(ModbusSlaveContext):
    """Blocks that begin at address 0 of a request; pymodbus 3.8 has no zero_mode any more, and adds one."""

    def validate(self, function, address, count=1):
        return super().validate(function, address - 1, count)

    def getValues(self, function, address, count=1):  # noqa: N802, pylint: disable=invalid-name
        return super().getValues(function, address - 1, count)

    def setValues(self, function, address, values):  # noqa: N802, pylint: disable=invalid-name
        super().setValues(function, address - 1, values)


class ModbusDevice:
    """One unit with input and holding registers; lives in a thread of the test."""

    def __init__(self, unit, input_registers=None, holding_registers=None):
        self.input = input_registers or Block()
        self.holding = holding_registers or Block()
        slave = Registers(ir=self.input, hr=self.holding)
        self._context = ModbusServerContext(slaves={unit: slave}, single=False)
        self._server = None

    def start_tcp(self, port):
        self._server = serve_tcp(self._context, port)

    def start_serial(self, line):
        self._server = serve_serial(self._context, line)

    def stop(self):
        """The device vanishes, and with it every link to it."""
        if self._server is None:
            return
        self._server.stop()
        self._server = None

    def holding_at(self, address, count=1):
        return self.holding.getValues(address, count)


class SerialPair:
    """Two ends of a serial line (socat)."""

    def __init__(self):
        self._folder = tempfile.TemporaryDirectory()
        self.device_end = os.path.join(self._folder.name, "device")
        self.driver_end = os.path.join(self._folder.name, "driver")
        self._socat = subprocess.Popen(
            [
                "socat",
                f"pty,raw,echo=0,link={self.device_end}",
                f"pty,raw,echo=0,link={self.driver_end}",
            ]
        )
        wait_for(
            lambda: os.path.exists(self.device_end) and os.path.exists(self.driver_end),
            "a pair of serial lines",
        )

    def close(self):
        self._socat.terminate()
        self._socat.wait()
        self._folder.cleanup()


class RudeServer:
    """Accepts links and answers every request with the same bytes, or with none."""

    def __init__(self, port, answer):
        self._answer = answer
        self._listener = socket.create_server(("127.0.0.1", port), reuse_port=False)
        self.requests = 0
        serve_each(self._listener, self._serve)

    def _serve(self, link):
        with link:
            while True:
                try:
                    if not link.recv(1024):
                        return
                    self.requests += 1
                    if self._answer:
                        link.sendall(self._answer)
                except OSError:
                    return

    def close(self):
        # Wakes the thread that accepts.
        self._listener.shutdown(socket.SHUT_RDWR)
        self._listener.close()
