"""What programs with sockets of their own share: free ports, whole receipts, and a thread for each who calls."""

import socket
import threading

_RESERVED = []


def free_port():
    """A port of this computer that nobody else is given as long as this process lives, however late it is used."""
    holder = socket.socket()
    # Bound but not listening: who names the port may listen there, as all servers set this option as well.
    holder.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    holder.bind(("127.0.0.1", 0))
    _RESERVED.append(holder)
    return holder.getsockname()[1]


def receive(link, count):
    """So many bytes; EOFError where the other side ends before."""
    received = b""
    while len(received) < count:
        part = link.recv(count - len(received))
        if not part:
            raise EOFError
        received += part
    return received


def serve_each(listener, serve):
    """Calls serve(link) in a thread of its own for each connection, until the listener is closed."""

    def accept():
        while True:
            try:
                link, _ = listener.accept()
            except OSError:
                return
            threading.Thread(target=serve, args=(link,), daemon=True).start()

    threading.Thread(target=accept, daemon=True).start()
