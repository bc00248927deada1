"""How the servo kernel is had as machine code, quickly.

numba compiles it in some seconds, and merely importing numba costs half a second, too much for every start. So the
object code is kept: built once, stored in the user's cache directory, and on every later start handed to llvmlite
alone, which takes a few milliseconds; numba is not even imported then. The file's name carries a digest of all
that could make it stale: the engine's kernel sources, the record layouts, the versions of numba, llvmlite and Python,
and the processor. Its content is guarded by a checksum; a damaged file is built anew, and a cache directory that
cannot be written only costs the time of building.

The kernel is called through ctypes in two ways: a call that releases the interpreter lock for long runs, and one that
keeps it for short ones, since handing the lock over and back costs more than a few samples.

With the environment variable OEM6250_KERNEL=interpreted the same source runs as plain Python, without any of this.
"""

from __future__ import annotations

import ctypes
import hashlib
import inspect
import os
import platform
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from importlib.metadata import version
from pathlib import Path
from types import FunctionType
from typing import Any

from . import cycle
from .kernels import KERNEL_FUNCTIONS, Records
from .layout import AXIS, SEGMENT, UNIT, WATCH
from .memory import Memory
from .watches import WATCH_SLOTS

MODE_VARIABLE = "OEM6250_KERNEL"
CACHE_VARIABLE = "OEM6250_CACHE_DIR"

BUILD_ESTIMATE_S = 10
"""What a build takes on a small machine, for the message only."""

# numba's run-time helpers that its C callback names for the handling of exceptions. The kernel raises none, so they are
# never called, but the linker wants an address for each where numba is not imported.
UNCALLED_HELPERS = (
    "NRT_Free",
    "NRT_MemInfo_call_dtor",
    "numba_do_raise",
    "numba_gil_ensure",
    "numba_gil_release",
    "numba_runtime_build_excinfo_struct",
    "numba_unpickle",
)

FILE_MARK = b"OEM6250 servo kernel 1\n"
DIGEST_BYTES = 32

OnBuild = Callable[[str], None]
Advance = Callable[[int], int]

_ARGUMENTS = (ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int64)
_RELEASING = ctypes.CFUNCTYPE(ctypes.c_int64, *_ARGUMENTS)
_KEEPING = ctypes.PYFUNCTYPE(ctypes.c_int64, *_ARGUMENTS)


@dataclass(frozen=True, slots=True)
class Calls:
    """The kernel bound to one unit's memory: `advance(until_ns) -> events`, in two ways of calling it."""

    long_run: Advance
    short_run: Advance


@dataclass(frozen=True, slots=True)
class Kernel:
    """The kernel, ready to be bound. `origin` is interpreted, cache, built, or memory (built, could not be stored)."""

    origin: str
    address: int
    keep_alive: Any

    def bind(self, memory: Memory) -> Calls:
        """Bind the kernel to a unit's arrays; to be repeated when one of them has moved."""
        if self.origin == "interpreted":
            return _bind_interpreted(memory)
        pointers = [array.ctypes.data for array in _arrays(memory)]
        return Calls(_bound(_RELEASING(self.address), pointers), _bound(_KEEPING(self.address), pointers))


@dataclass(frozen=True, slots=True)
class ObjectCode:
    """Compiled kernel as an object file and the name of its entry point."""

    symbol: str
    code: bytes


_loaded: dict[str, Kernel] = {}


def load_kernel(on_build: OnBuild | None = None) -> Kernel:
    """The kernel of this process: interpreted if the environment says so, else from the cache, else built.

    `on_build` is called once with a sentence for the user before a build.
    """
    mode = os.environ.get(MODE_VARIABLE, "")
    if mode not in _loaded:
        _loaded[mode] = Kernel("interpreted", 0, None) if mode == "interpreted" else load_compiled(on_build)
    return _loaded[mode]


def load_compiled(on_build: OnBuild | None = None) -> Kernel:
    """The compiled kernel from the cache, else newly built and stored."""
    path = cache_path()
    cached = read_object(path)
    if cached is not None:
        try:
            return link(cached)
        except RuntimeError:
            # Whole, yet not what this numba would make, such as a file written by a broken build: build again.
            pass
    if on_build is not None:
        on_build(f"building the servo kernel for this machine, about {BUILD_ESTIMATE_S} s")
    return build(path)


def cache_path() -> Path:
    """Where this kernel's object code is kept; OEM6250_CACHE_DIR overrides the directory."""
    directory = os.environ.get(CACHE_VARIABLE)
    if not directory:
        from platformdirs import user_cache_dir

        directory = user_cache_dir("oem6250", appauthor=False)
    return Path(directory) / f"servo-{_fingerprint()}.kernel"


def read_object(path: Path) -> ObjectCode | None:
    """The object code in a cache file; None if there is none, or it is not whole."""
    try:
        content = path.read_bytes()
    except OSError:
        return None
    body = content[len(FILE_MARK) + DIGEST_BYTES :]
    if content[: len(FILE_MARK)] != FILE_MARK:
        return None
    if hashlib.sha256(body).digest() != content[len(FILE_MARK) : len(FILE_MARK) + DIGEST_BYTES]:
        return None
    symbol, _, code = body.partition(b"\n")
    return ObjectCode(symbol.decode(), code)


def write_object(path: Path, compiled: ObjectCode) -> bool:
    """Store object code so that a reader sees the whole file or none; False if the directory cannot be written."""
    body = compiled.symbol.encode() + b"\n" + compiled.code
    temporary = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=path.parent, suffix=".part", delete=False) as file:
            temporary = Path(file.name)
            file.write(FILE_MARK + hashlib.sha256(body).digest() + body)
        temporary.replace(path)
    except OSError:
        if temporary is not None:
            temporary.unlink(missing_ok=True)
        return False
    return True


def link(compiled: ObjectCode) -> Kernel:
    """Load object code into this process; RuntimeError if it lacks its entry point.

    Only whole object code may come here: llvm ends the process over anything else, hence the checksum of the file.
    """
    import llvmlite.binding as llvm

    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    never_called = ctypes.cast(ctypes.pythonapi.Py_FatalError, ctypes.c_void_p).value
    for name in UNCALLED_HELPERS:
        if llvm.address_of_symbol(name) is None:
            llvm.add_symbol(name, never_called)
    machine = llvm.Target.from_default_triple().create_target_machine()
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), machine)
    engine.add_object_file(llvm.ObjectFileRef.from_data(compiled.code))
    engine.finalize_object()
    address = engine.get_function_address(compiled.symbol)
    if not address:
        raise RuntimeError("the object code lacks its entry point")
    return Kernel("cache", address, engine)


def build(path: Path) -> Kernel:
    """Compile the kernel with numba and store it at `path` if that is possible."""
    function = _compile()
    try:
        compiled = ObjectCode(function._wrapper_name, bytes(function._library._get_compiled_object()))
    except AttributeError:
        # numba's inside has changed: the kernel still runs, it only cannot be kept.
        return Kernel("memory", function.address, function)
    stored = write_object(path, compiled)
    return Kernel("built" if stored else "memory", function.address, function)


def _compile() -> Any:
    """The kernel's entry point as a numba C callback, every registered function compiled into it.

    The functions are compiled as copies whose globals name the compiled callees; the originals stay plain Python.
    """
    numba: Any = import_module("numba")
    compiled: dict[int, Any] = {}
    for function in KERNEL_FUNCTIONS:
        names = {name: compiled.get(id(value), value) for name, value in function.__globals__.items()}
        copy = FunctionType(function.__code__, names, function.__name__)
        compiled[id(function)] = numba.njit(nogil=True, error_model="numpy")(copy)
    advance, carray = compiled[id(cycle.advance)], numba.carray

    def entry(unit_at, axes_at, segments_at, watches_at, until_ns):  # type: ignore[no-untyped-def]
        unit = carray(unit_at, (1,))[0]
        axis_count = unit["axis_count"]
        axes = carray(axes_at, (axis_count,))
        segments = carray(segments_at, (axis_count * unit["segment_capacity"],))
        watches = carray(watches_at, (WATCH_SLOTS,))
        return advance(unit, axes, segments, watches, until_ns)

    pointers = [numba.types.CPointer(numba.from_dtype(dtype)) for dtype in (UNIT, AXIS, SEGMENT, WATCH)]
    return numba.cfunc(numba.types.int64(*pointers, numba.types.int64), error_model="numpy")(entry)


def _fingerprint() -> str:
    """Digest of everything the object code depends on."""
    import llvmlite.binding as llvm

    digest = hashlib.sha256()
    for source in sorted({inspect.getfile(function) for function in KERNEL_FUNCTIONS} | {__file__}):
        digest.update(Path(source).read_bytes())
    facts = (
        [dtype.descr for dtype in (UNIT, AXIS, SEGMENT, WATCH)],
        [version(name) for name in ("numba", "llvmlite", "numpy")],
        sys.version,
        platform.machine(),
        llvm.get_host_cpu_name(),
        llvm.get_host_cpu_features().flatten(),
    )
    digest.update(repr(facts).encode())
    return digest.hexdigest()[:32]


def _arrays(memory: Memory) -> tuple[Records, Records, Records, Records]:
    return memory.units, memory.axes, memory.segments, memory.watches


def _bound(function: Any, pointers: list[int]) -> Advance:
    unit, axes, segments, watches = pointers

    def advance(until_ns: int) -> int:
        return int(function(unit, axes, segments, watches, until_ns))

    return advance


def _bind_interpreted(memory: Memory) -> Calls:
    units, axes, segments, watches = _arrays(memory)

    def advance(until_ns: int) -> int:
        return int(cycle.advance(units[0], axes, segments, watches, until_ns))

    return Calls(advance, advance)
