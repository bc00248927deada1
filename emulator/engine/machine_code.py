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
from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass
from importlib import import_module
from importlib.metadata import version
from pathlib import Path
from types import FunctionType
from typing import Any

import numpy as np

from . import cycle, lanes
from .kernels import CALLED_FUNCTIONS, KERNEL_FUNCTIONS
from .layout import AXIS, PLANT, RATIO, SCOPE, SEGMENT, UNIT, WATCH, WORD_BYTES
from .memory import SEGMENT_BANKS, Memory
from .scope import ScopeArrays
from .watches import WATCH_SLOTS

MODE_VARIABLE = "OEM6250_KERNEL"
CACHE_VARIABLE = "OEM6250_CACHE_DIR"

BUILD_ESTIMATE_S = 25
"""What a build takes on a small machine, for the message only."""
FOR_THIS_MACHINE = f"for this machine, about {BUILD_ESTIMATE_S} s"

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

LEAN_FUNCTIONS = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True, "_nrt": False}
"""numba's options by which the functions called from the entry point get no wrappers for Python, which are a third of
a build, and count no references to their arrays: they make and keep none, and counting takes a quarter of a sample."""

FILE_MARK = b"OEM6250 servo kernel 1\n"
DIGEST_BYTES = 32

UNIT_WORDS = UNIT.itemsize // WORD_BYTES
AXIS_WORDS = AXIS.itemsize // WORD_BYTES

ONE_UNIT = 0
"""Number of lanes that stands for a unit by itself, which runs only up to its next event."""

OnBuild = Callable[[str], None]
Function = Callable[..., Any]
Advance = Callable[[int], int]

_ARGUMENTS = (ctypes.c_void_p, ctypes.c_int64, ctypes.c_int64)
RELEASING = ctypes.CFUNCTYPE(ctypes.c_int64, *_ARGUMENTS)
"""How an entry point is called that gives the interpreter lock away meanwhile."""
KEEPING = ctypes.PYFUNCTYPE(ctypes.c_int64, *_ARGUMENTS)
"""How one is called that keeps it."""


@dataclass(frozen=True, slots=True)
class Calls:
    """The kernel bound to one unit's memory: `advance(until_ns) -> events`, in two ways of calling it.

    `keep_alive` holds what the calls point to.
    """

    long_run: Advance
    short_run: Advance
    keep_alive: Any


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
        table = memory.addresses()
        place = table.ctypes.data
        return Calls(_bound(RELEASING(self.address), place), _bound(KEEPING(self.address), place), table)

    def bind_lanes(self, memory: Memory, count: int) -> Advance:
        """Bind the kernel to the arrays of `count` units; the call releases the interpreter lock and returns 0."""
        if self.origin == "interpreted":
            return _bind_interpreted_lanes(memory)
        table = memory.addresses()
        function = RELEASING(self.address)

        def advance(until_ns: int) -> int:
            return int(function(table.ctypes.data, count, until_ns))

        return advance


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
    return cached_kernel(path) or build_saying(f"building the servo kernel {FOR_THIS_MACHINE}", build, path, on_build)


def cached_kernel(path: Path) -> Kernel | None:
    """The kernel in a cache file, if it is whole and has its entry point."""
    cached = read_object(path)
    if cached is None:
        return None
    try:
        return link(cached)
    except RuntimeError:
        # Whole, yet not what this numba would make, such as a file written by a broken build: build again.
        return None


def build_saying(sentence: str, build: Callable[[Path], Kernel], path: Path, on_build: OnBuild | None) -> Kernel:
    """Build a kernel, after a sentence for the user."""
    if on_build is not None:
        on_build(sentence)
    return build(path)


def cache_path() -> Path:
    """Where this kernel's object code is kept; OEM6250_CACHE_DIR overrides the directory."""
    records = (UNIT, AXIS, PLANT, SEGMENT, RATIO, WATCH, SCOPE)
    return cache_file("servo", fingerprint(KERNEL_FUNCTIONS, records, also=(__file__,)))


def cache_file(name: str, digest: str) -> Path:
    """Where the object code of a kernel of this name and digest is kept."""
    directory = os.environ.get(CACHE_VARIABLE)
    if not directory:
        from platformdirs import user_cache_dir

        directory = user_cache_dir("oem6250", appauthor=False)
    return Path(directory) / f"{name}-{digest}.kernel"


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
    return keep(_compile(), path)


def keep(function: Any, path: Path) -> Kernel:
    """The kernel of a numba C callback, its object code stored at `path` if that is possible."""
    try:
        compiled = ObjectCode(function._wrapper_name, bytes(function._library._get_compiled_object()))
    except AttributeError:
        # numba's inside has changed: the kernel still runs, it only cannot be kept.
        return Kernel("memory", function.address, function)
    stored = write_object(path, compiled)
    return Kernel("built" if stored else "memory", function.address, function)


def _compile() -> Any:
    """The kernel's entry point as a numba C callback, every registered function compiled into it.

    The functions are compiled as copies whose globals name the compiled callees; the originals stay plain Python. The
    entry takes the table of `Memory.addresses`: one pointer costs a caller less than eight.
    """
    numba, compiled = compile_functions(KERNEL_FUNCTIONS, CALLED_FUNCTIONS)
    advance_one, advance_lanes, carray = compiled[id(cycle.advance)], compiled[id(lanes.advance_lanes)], numba.carray

    def entry(table, lane_count, until_ns):  # type: ignore[no-untyped-def]
        count = max(lane_count, 1)
        units = carray(table[0], (count,), UNIT)
        axis_count = units[0]["axis_count"]
        axes = carray(table[1], (count * axis_count,), AXIS)
        plants = carray(table[2], (count * axis_count * 2,), PLANT)
        segments = carray(table[3], (SEGMENT_BANKS * axis_count * units[0]["segment_capacity"],), SEGMENT)
        watches = carray(table[4], (WATCH_SLOTS,), WATCH)
        ratios = carray(table[9], (axis_count * units[0]["ratio_capacity"],), RATIO)
        scopes = carray(table[5], (count,), SCOPE)
        ring_words = scopes[0]["rows"] * (scopes[0]["axis_channels"] + scopes[0]["unit_channels"])
        scope = ScopeArrays(
            scopes,
            carray(table[6], (scopes[0]["axis_channels"] + 1,), np.int64),
            carray(table[7], (scopes[0]["unit_channels"] + 1,), np.int64),
            carray(table[0], (count * UNIT_WORDS,), np.int64),
            carray(table[0], (count * UNIT_WORDS,), np.float64),
            carray(table[1], (count * axis_count * AXIS_WORDS,), np.int64),
            carray(table[1], (count * axis_count * AXIS_WORDS,), np.float64),
            carray(table[8], (count * ring_words,), np.int64),
        )
        if lane_count == 0:
            return advance_one(units[0], axes, plants, segments, ratios, watches, scope, until_ns)
        return advance_lanes(units, axes, plants, segments, ratios, watches, scope, until_ns)

    return as_callback(numba, entry)


def compile_functions(functions: Iterable[Function], called: Collection[Function]) -> tuple[Any, dict[int, Any]]:
    """numba, and by the id of each of the functions (callees first) its copy that numba compiles when it is called."""
    numba: Any = import_module("numba")
    options = known_options(import_module("numba.core.options"))
    compiled: dict[int, Any] = {}
    for function in functions:
        names = {name: compiled.get(id(value), value) for name, value in function.__globals__.items()}
        copy = FunctionType(function.__code__, names, function.__name__)
        inline = function not in called
        compiled[id(function)] = numba.njit(error_model="numpy", forceinline=inline, **options)(copy)
    return numba, compiled


def known_options(numba_options: Any) -> dict[str, bool]:
    """Those of LEAN_FUNCTIONS that this numba knows."""
    return {name: value for name, value in LEAN_FUNCTIONS.items() if hasattr(numba_options.DefaultOptions, name)}


def as_callback(numba: Any, entry: Any) -> Any:
    """`entry(table of addresses, number, number) -> number` as a numba C callback."""
    table = numba.types.CPointer(numba.types.voidptr)
    return numba.cfunc(numba.types.int64(table, numba.types.int64, numba.types.int64), error_model="numpy")(entry)


def fingerprint(functions: Iterable[Function], records: Iterable[np.dtype], *, also: Iterable[str]) -> str:
    """Digest of everything the object code of these functions on these records depends on; `also` are source files."""
    import llvmlite.binding as llvm

    digest = hashlib.sha256()
    for source in sorted({inspect.getfile(function) for function in functions} | set(also)):
        digest.update(Path(source).read_bytes())
    facts = (
        [dtype.descr for dtype in records],
        [version(name) for name in ("numba", "llvmlite", "numpy")],
        sys.version,
        platform.machine(),
        llvm.get_host_cpu_name(),
        llvm.get_host_cpu_features().flatten(),
    )
    digest.update(repr(facts).encode())
    return digest.hexdigest()[:32]


def _bound(function: Any, table: int) -> Advance:
    def advance(until_ns: int) -> int:
        return int(function(table, ONE_UNIT, until_ns))

    return advance


def _bind_interpreted(memory: Memory) -> Calls:
    arrays = (
        memory.units[0],
        memory.axes,
        memory.plants,
        memory.segments,
        memory.ratios,
        memory.watches,
        memory.scope_arrays(),
    )

    def advance(until_ns: int) -> int:
        return int(cycle.advance(*arrays, until_ns))

    return Calls(advance, advance, arrays)


def _bind_interpreted_lanes(memory: Memory) -> Advance:
    arrays = (
        memory.units,
        memory.axes,
        memory.plants,
        memory.segments,
        memory.ratios,
        memory.watches,
        memory.scope_arrays(),
    )

    def advance(until_ns: int) -> int:
        return lanes.advance_lanes(*arrays, until_ns)

    return advance
