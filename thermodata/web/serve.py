"""Opens a port of 127.0.0.1 and answers there until it is interrupted."""

from __future__ import annotations

import socket
import sys
from collections.abc import Callable
from pathlib import Path

from thermodata.errors import UsageError
from thermodata.web.desk import Desk, desk_of
from thermodata.web.guard import TICKET_PATH

LOOPBACK = "127.0.0.1"


def listen(port: int = 0) -> socket.socket:
    """A listening socket of this machine alone. port: 0 takes any that is free. UsageError where it is taken."""
    made = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    if sys.platform != "win32":  # where it would let another program share the port
        made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        made.bind((LOOPBACK, port))
        made.listen(64)
    except OSError as error:
        made.close()
        raise UsageError(
            f"port {port} can't be opened", got=error.strerror or str(error), hint="--port 0 takes any that is free"
        ) from error
    return made


def ticket_address(desk: Desk) -> str:
    """The address that lets a browser in, once."""
    return f"{desk.address}{TICKET_PATH}?ticket={desk.keys.ticket}"


def serve(
    given: Path | None,
    store: Path | None,
    *,
    write: bool,
    port: int,
    opened: Callable[[Desk], None],
    otherwise: Path | None = None,
) -> None:
    """Runs until it is interrupted. given, store, otherwise: see `desk_of`. opened: is told once the port listens."""
    import uvicorn

    from thermodata.web.app import application

    with listen(port) as bound:
        desk = desk_of(given, store, write=write, port=bound.getsockname()[1], otherwise=otherwise)
        # no access log: an address may hold the ticket
        config = uvicorn.Config(
            application(desk),
            log_level="warning",
            access_log=False,
            server_header=False,
            date_header=False,
            proxy_headers=False,
            ws="none",
            lifespan="on",
            h11_max_incomplete_event_size=1 << 16,
            timeout_graceful_shutdown=2,
        )
        opened(desk)
        uvicorn.Server(config).run(sockets=[bound])
