"""What runs a sweep's jobs: a pool of threads, or a cluster.

Threads rather than processes: the kernel and numpy's passes over the recordings release the interpreter lock, so two
threads keep two processors busy as well as two processes do, and nothing is copied or started.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager
from importlib import import_module
from typing import Any

CONNECT_TIMEOUT_S = 10.0
"""How long a cluster may take to answer, s (design choice)."""


class ClusterError(RuntimeError):
    """The cluster cannot be used; the message is one line."""


def processors() -> int:
    """Processors this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


@contextmanager
def local(jobs: int) -> Iterator[Executor]:
    """A pool of so many threads; also for one, since the main thread gives freed memory back to the system after every
    job and is a quarter slower for it (measured with glibc)."""
    with ThreadPoolExecutor(jobs, thread_name_prefix="sweep") as pool:
        yield pool


@contextmanager
def cluster(address: str) -> Iterator[Executor]:
    """The workers of a Dask cluster as an executor. They need this package installed.

    Raises:
        ClusterError: Dask is not installed, or there is no cluster at the address.
    """
    try:
        distributed: Any = import_module("distributed")
    except ImportError:
        raise ClusterError("--cluster needs Dask: pip install 'oem6250[cluster]'") from None
    try:
        client = distributed.Client(address, timeout=CONNECT_TIMEOUT_S, set_as_default=False)
    except (OSError, ValueError, TypeError) as error:
        raise ClusterError(f"no cluster at {address}: {' '.join(str(error).split())}") from None
    with client:
        try:
            yield client.get_executor(pure=False)
        except ImportError as error:
            raise ClusterError(f"the workers at {address} cannot run this: {error}") from None
