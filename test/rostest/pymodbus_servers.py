"""Servers of whichever pymodbus is installed: 2.1 of Debian 11, 3.0 of Debian 12, 3.8 of Debian 13.

Each serves the registers of a context in a thread of its own, until stop().
"""

import asyncio
import socket
import threading

try:
    from pymodbus.server.sync import ModbusSerialServer, ModbusTcpServer

    THREADED = True
except ImportError:
    THREADED = False
    try:
        from pymodbus.server import ModbusSerialServer, ModbusTcpServer
    except ImportError:
        from pymodbus.server.async_io import ModbusSerialServer, ModbusTcpServer
try:
    from pymodbus.framer import FramerType

    TCP = {"framer": FramerType.SOCKET}
    RTU = {"framer": FramerType.RTU}
except ImportError:
    from pymodbus.transaction import ModbusRtuFramer, ModbusSocketFramer

    TCP = {"framer": ModbusSocketFramer, "allow_reuse_address": True}
    RTU = {"framer": ModbusRtuFramer}

SERIAL = {"baudrate": 115200, "timeout": 0.005}


class _AsynchronousServer:
    """Runs the event loop of a server of pymodbus 3."""

    def __init__(self, make):
        self._make = make
        self._loop = asyncio.new_event_loop()
        self._ended = None
        ready = threading.Event()
        self._thread = threading.Thread(target=self._run, args=(ready,), daemon=True)
        self._thread.start()
        ready.wait()

    def _run(self, ready):
        asyncio.set_event_loop(self._loop)
        self._loop.run_until_complete(self._serve(ready))

    async def _serve(self, ready):
        self._ended = asyncio.Event()
        server = self._make()
        if hasattr(server, "start"):
            await server.start()
        serving = asyncio.ensure_future(server.serve_forever())
        ready.set()
        await self._ended.wait()
        await server.shutdown()
        serving.cancel()

    def stop(self):
        self._loop.call_soon_threadsafe(self._ended.set)
        self._thread.join()


class _ThreadedTcpServer:
    """Runs a server of pymodbus 2, which has a thread for each link."""

    def __init__(self, server):
        self._server = server
        self._thread = threading.Thread(target=server.serve_forever, daemon=True)
        self._thread.start()

    def stop(self):
        self._server.shutdown()
        self._server.server_close()
        for link in list(self._server.threads):
            link.request.shutdown(socket.SHUT_RDWR)
        self._thread.join()


class _ThreadedSerialServer:
    """Runs a server of pymodbus 2 on a serial line."""

    def __init__(self, server):
        self._server = server
        self._thread = threading.Thread(target=server.serve_forever, daemon=True)
        self._thread.start()

    def stop(self):
        self._server.is_running = False
        self._server.handler.running = False
        self._thread.join()
        self._server.socket.close()


def serve_tcp(context, port):
    def make():
        return ModbusTcpServer(context, address=("127.0.0.1", port), **TCP)

    return _ThreadedTcpServer(make()) if THREADED else _AsynchronousServer(make)


def serve_serial(context, line):
    def make():
        return ModbusSerialServer(context, port=line, **RTU, **SERIAL)

    return _ThreadedSerialServer(make()) if THREADED else _AsynchronousServer(make)
