# SPDX-License-Identifier: Apache-2.0
"""libblob-cuda by ctypes: models in the memory of NVIDIA devices, and queries at addresses there.

The library is the file that LUMEN_BLOB_CUDA_LIBRARY names, else libblob-cuda.so.1 beside this module,
else the system's (Debian: libblob-cuda1). blob_cuda.h states what a query does.
"""
import ctypes
import functools
import os
import threading
import weakref
from ctypes import POINTER, byref, c_char_p, c_int, c_size_t, c_uint32, c_void_p
from typing import Any

import numpy as np

from . import blob

NAME = "libblob-cuda.so.1"


class _Definition(ctypes.Structure):
    _fields_ = [("device", c_int), ("message", c_char_p), ("message_size", c_size_t), ("cookie", c_uint32)]


class _Columns(ctypes.Structure):
    _fields_ = [("count", c_uint32), ("vessel", c_uint32), ("vessel_of_point", c_void_p), ("point", c_void_p),
                ("cursor", c_void_p), ("answer", c_void_p), ("value", c_void_p), ("state", c_void_p),
                ("cookie", c_uint32)]


@functools.lru_cache(maxsize=None)
def library():
    """blob_cuda.h with its types. Raises ImportError where there is no such library."""
    beside = os.path.join(os.path.dirname(os.path.abspath(__file__)), NAME)
    path = os.environ.get("LUMEN_BLOB_CUDA_LIBRARY") or (beside if os.path.exists(beside) else NAME)
    try:
        lib = ctypes.CDLL(path)
    except OSError as error:
        raise ImportError(f"libblob-cuda, which queries on CUDA devices need, cannot be loaded ({error}); install it "
                          "(Debian: libblob-cuda1), set LUMEN_BLOB_CUDA_LIBRARY to its path, or ask in the processor's "
                          "memory") from error
    for name, result, arguments in (
            ("blob_cuda_status_text", c_char_p, [c_int]),
            ("blob_cuda_def_default", _Definition, []),
            ("blob_cuda_create", c_int, [c_void_p, c_size_t, POINTER(_Definition), POINTER(c_void_p)]),
            ("blob_cuda_close", None, [c_void_p]),
            ("blob_cuda_columns_default", _Columns, []),
            ("blob_cuda_query", c_int, [c_void_p, c_void_p, c_uint32, POINTER(_Columns)])):
        function = getattr(lib, name)
        function.restype, function.argtypes = result, arguments
    return lib


class Vessels:
    """A packed buffer and the kernels on a device.

    Parameters
    ----------
    words : array (n,) of uint32
        A buffer of lumen.blob.pack().
    device : int
        Number of the device, whose primary context is used.
    wait : callable, optional
        Waits until the device has answered all queries; called before its memory is freed.

    Raises RuntimeError with the driver's reason, ImportError without the library.
    """

    def __init__(self, words, device, wait=None):
        lib = library()
        words = np.ascontiguousarray(words, np.uint32)
        message = ctypes.create_string_buffer(500)
        definition = lib.blob_cuda_def_default()
        definition.device = device
        definition.message, definition.message_size = ctypes.cast(message, c_char_p), len(message)
        self._handle = c_void_p()
        _check(lib, lib.blob_cuda_create(words.ctypes.data, words.nbytes, definition, byref(self._handle)), message.value)
        weakref.finalize(self, _close, lib, self._handle, wait).atexit = False  # the driver frees what a process leaves

    def query(self, count, point, cursor, answer, flags=blob.DISTANCE_EXACT, stream=0):
        """Launches blob_cuda_query() and returns before the answers are there.

        Parameters
        ----------
        count : int
            Number of points, less than 2^32.
        point, cursor, answer : int
            Addresses on the device: (count, 3) float32, mm; (count,) uint32, which move; (count, 4) float32, distance in
            mm and outward normal.
        flags : int
            As for Model.query().
        stream : int
            Address of a CUstream of the device; 0: its default stream.

        Raises ValueError for too many points, RuntimeError where the driver refuses.
        """
        if count >= 1 << 32:
            raise ValueError(f"points: found {count}, expected less than 2^32")
        lib = library()
        columns = lib.blob_cuda_columns_default()
        columns.count, columns.point, columns.cursor, columns.answer = count, point, cursor, answer
        _check(lib, lib.blob_cuda_query(self._handle, stream or None, flags, byref(columns)))


def _check(lib, status, reason=b""):
    if status != 0:
        text = lib.blob_cuda_status_text(status).decode()
        raise RuntimeError(f"libblob-cuda: {text}" + (f": {reason.decode(errors='replace')}" if reason else ""))


def _close(lib, handle, wait):
    if wait is not None:
        wait()
    lib.blob_cuda_close(handle)


_kept: Any = weakref.WeakKeyDictionary()  # the vessels of each model by the number of the device
_lock = threading.Lock()


def vessels(model, device, wait=None) -> Vessels:
    """The model on a device, uploaded by the first call and kept while the model lives; arguments as for Vessels."""
    with _lock:
        devices = _kept.setdefault(model, {})
        if device not in devices:
            devices[device] = Vessels(blob.pack(model), device, wait)
        return devices[device]
