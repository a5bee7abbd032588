"""Connections to the scheduler of a Dask cluster."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import TYPE_CHECKING

from hrcplan.core.extras import require
from hrcplan.core.files import read_bytes
from hrcplan.core.json_values import DOCUMENT_FAULTS, json_of
from hrcplan.errors import InputError, PlannerError, UsageError

if TYPE_CHECKING:
    from distributed import Client

ANSWER_S = 5.0
"""How long a scheduler may take to answer."""
CLOSE_S = 3.0
HINT = "as in tcp://node1:8786; start a scheduler with: dask scheduler"
LOGGERS = ("distributed", "distributed.client", "distributed.comm")


def find_scheduler(place: str) -> str:
    """Return the address of a scheduler, after it has answered.

    Args:
        place: Its address, such as ``tcp://node1:8786``, or the path of its ``--scheduler-file``,
            which ends in ``.json``.

    Raises:
        UsageError: if the extra ``cluster`` is not installed, or this is no address.
        InputError: if the file is missing or names no address.
        PlannerError: if no scheduler answers.
    """
    require("distributed", "--cluster")
    import dask

    # The messages of hrcplan say the same in fewer words.
    with dask.config.set({"logging": dict.fromkeys(LOGGERS, "critical")}):
        from distributed.comm.addressing import parse_address, parse_host_port

    address = _address_in(place) if place.endswith(".json") else place
    try:
        parse_host_port(parse_address(address)[1])
        kind = asyncio.run(asyncio.wait_for(_kind_at(address), ANSWER_S))
    except (ValueError, TypeError, ArithmeticError, ImportError) as error:
        message = f"'{address}' is no address of a scheduler: {error}"
        raise UsageError(message, code="bad-address", hint=HINT) from None
    except (TimeoutError, OSError) as error:
        why = f": {error}" if str(error) else ""
        message = f"no scheduler answers at {address}{why}"
        raise PlannerError(message, code="no-cluster", hint=HINT) from None
    if kind != "Scheduler":
        message = f"at {address} is a {kind.lower()}, not the scheduler"
        raise UsageError(message, code="bad-address", hint=HINT)
    return address


def connect(address: str) -> Client:
    """Return a client of a scheduler that has answered before.

    `find_scheduler` refuses all else, since a client that cannot start cannot be closed.
    """
    from distributed import Client

    return Client(address, timeout=ANSWER_S, set_as_default=False, name="hrcplan")


async def _kind_at(address: str) -> str:
    """Return what answers at an address: ``Scheduler``, ``Worker`` or ``Nanny``."""
    from distributed.core import rpc
    from distributed.security import Security

    peer = rpc(address, timeout=ANSWER_S, connection_args=Security().get_connection_args("client"))
    try:
        return str((await peer.identity())["type"])
    finally:
        await peer.close_rpc()


def _address_in(path: str) -> str:
    """Return the address in a ``--scheduler-file``.

    Raises:
        InputError: if the file is missing or names none.
    """
    try:
        return str(json_of(read_bytes(Path(path)))["address"])
    except DOCUMENT_FAULTS as error:
        message = f"{path} names no address of a scheduler: {error!r}"
        raise InputError(message, code="bad-address", path=path) from None
