"""The reference of every round trip: the shortest asyncio server that answers. `python -m tests.bench.echo`."""

from __future__ import annotations

import asyncio
import json


class Echo(asyncio.Protocol):
    """Sends back whatever arrives."""

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        assert isinstance(transport, asyncio.Transport)
        self.transport = transport

    def data_received(self, data: bytes) -> None:
        self.transport.write(data)


async def serve() -> None:
    """Serve on a free port until killed, told on stdout in the form of the emulator's announcement."""
    server = await asyncio.get_running_loop().create_server(Echo, "127.0.0.1", 0)
    host, port = server.sockets[0].getsockname()
    print(json.dumps({"tcp": [f"{host}:{port}"]}), flush=True)
    await server.serve_forever()


if __name__ == "__main__":
    asyncio.run(serve())
