"""What programs with sockets of their own share: whole receipts, and a thread for each who calls."""

import threading


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
