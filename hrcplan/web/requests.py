"""What requests bring, and the replies of sessions."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from concurrent.futures import Future
from typing import Any
from urllib.parse import parse_qs

from starlette.requests import Request
from starlette.responses import Response

from hrcplan.core.json_values import json_of
from hrcplan.errors import InputError, UsageError

ANSWER_S = 30.0  # how long a page waits for an answer before it asks again
Handler = Callable[[Request], Awaitable[Response]]


async def form_of(request: Request) -> dict[str, str]:
    """Return the first value of each field of a form."""
    text = (await request.body()).decode("utf-8", "replace")
    return {key: values[0] for key, values in parse_qs(text).items()}


async def document_of(request: Request) -> dict[str, Any]:
    """Return the JSON object of a request.

    Raises:
        InputError: if it has none.
    """
    try:
        document = json_of(await request.body())
    except ValueError:
        document = None
    if not isinstance(document, dict):
        raise InputError("a JSON object is needed", code="bad-request")
    return document


async def reply_of(future: Future[Any]) -> Any:
    """Return what a session replies.

    Raises:
        UsageError: if it takes too long.
    """
    try:
        return await asyncio.wait_for(asyncio.wrap_future(future), ANSWER_S)
    except TimeoutError:
        raise UsageError("the robot still thinks", code="slow") from None
