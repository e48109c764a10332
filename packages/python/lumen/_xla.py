# SPDX-License-Identifier: Apache-2.0
"""Queries of libblob-cuda as a call of XLA's foreign function interface, on the stream of the compiled program.

A handler of that interface is a C function of one structure, which states its own size and version
(openxla/xla, xla/ffi/api/c_api.h, version 0.1; later ones append). The structures are declared here for ctypes, so
that nothing is compiled against JAX.
"""
import ctypes
import functools
import itertools
import math
import threading
from ctypes import POINTER, byref, c_char_p, c_int, c_int32, c_int64, c_size_t, c_uint32, c_void_p
from typing import Any, Dict

from . import _cuda

TARGET = "lumen_blob_distance_exact"
_VERSION = (0, 1)  # of the interface, the oldest that runtimes take
_METADATA = 1  # type of an extension
_INVALID_ARGUMENT, _INTERNAL = 3, 13  # codes of errors
_S64, _SCALAR = 5, 3  # type of a number, kind of an attribute


class _Extension(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("type", c_int), ("next", c_void_p)]


class _Version(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("extension", c_void_p), ("major", c_int), ("minor", c_int)]


class _Metadata(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("version", _Version), ("traits", c_uint32)]


class _MetadataExtension(ctypes.Structure):
    _fields_ = [("base", _Extension), ("metadata", POINTER(_Metadata))]


class _Buffer(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("extension", c_void_p), ("dtype", c_int), ("data", c_void_p), ("rank", c_int64),
                ("dims", POINTER(c_int64))]


class _Buffers(ctypes.Structure):  # arguments, and results
    _fields_ = [("size", c_size_t), ("extension", c_void_p), ("count", c_int64), ("types", POINTER(c_int)),
                ("at", POINTER(POINTER(_Buffer)))]


class _Scalar(ctypes.Structure):
    _fields_ = [("dtype", c_int), ("value", POINTER(c_int64))]


class _Attributes(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("extension", c_void_p), ("count", c_int64), ("types", POINTER(c_int)),
                ("names", c_void_p), ("at", POINTER(POINTER(_Scalar)))]


class _ErrorArguments(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("extension", c_void_p), ("message", c_char_p), ("code", c_int)]


class _StreamArguments(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("extension", c_void_p), ("context", c_void_p), ("stream", c_void_p)]


class _OrdinalArguments(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("extension", c_void_p), ("context", c_void_p), ("ordinal", c_int32)]


_CreateError = ctypes.CFUNCTYPE(c_void_p, POINTER(_ErrorArguments))
_GetStream = ctypes.CFUNCTYPE(c_void_p, POINTER(_StreamArguments))
_GetOrdinal = ctypes.CFUNCTYPE(c_void_p, POINTER(_OrdinalArguments))


class _Interface(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("extension", c_void_p), ("version", _Version), ("internal", c_void_p),
                ("create_error", _CreateError), ("unused_before_stream", c_void_p * 3), ("get_stream", _GetStream),
                ("unused_before_ordinal", c_void_p * 12), ("get_ordinal", _GetOrdinal)]


class _Frame(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("extension", POINTER(_Extension)), ("interface", POINTER(_Interface)),
                ("context", c_void_p), ("stage", c_int), ("arguments", _Buffers), ("results", _Buffers),
                ("attributes", _Attributes)]


_models: Dict[int, Any] = {}  # of numbers that compiled programs hold, which JAX may keep for the life of the process
_numbers = itertools.count()
_lock = threading.Lock()


def number_of(model) -> int:
    """The number by which a compiled program names a model, which then lives as long as the process."""
    with _lock:
        for number, known in _models.items():
            if known is model:
                return number
        number = next(_numbers)
        _models[number] = model
        return number


@functools.lru_cache(maxsize=None)
def register(ffi):
    """Makes the call known to JAX, whose module jax.ffi is given, for CUDA.

    Its arguments are points (..., 3) float32, nodes (...) uint32, and the attribute `model` (int64), its results are
    answers (..., 4) float32, distance in mm and normal, and nodes, in the memory of the argument.
    """
    ffi.register_ffi_target(TARGET, ffi.pycapsule(ctypes.cast(_handler, c_void_p).value), platform="CUDA")


@ctypes.CFUNCTYPE(c_void_p, POINTER(_Frame))
def _handler(frame):
    """The handler: null, or an error that the runtime frees. No exception may leave it."""
    frame = frame.contents
    extension = frame.extension
    if extension and extension.contents.type == _METADATA:
        metadata = ctypes.cast(extension, POINTER(_MetadataExtension)).contents.metadata.contents
        metadata.version.major, metadata.version.minor = _VERSION
        return None
    try:
        return _query(frame)
    except ValueError as error:
        return _error(frame, _INVALID_ARGUMENT, error)
    except BaseException as error:  # pylint: disable=broad-exception-caught
        return _error(frame, _INTERNAL, error)


def _error(frame, code, error):
    message = f"lumen.jax: {error}".encode()
    return frame.interface.contents.create_error(byref(_ErrorArguments(ctypes.sizeof(_ErrorArguments), None, message, code)))


def _query(frame):
    """Launches the query of a frame. Returns null or an error of the runtime; raises its own."""
    interface = frame.interface.contents
    if interface.size < _Interface.get_ordinal.offset + _Interface.get_ordinal.size:
        raise RuntimeError("this JAX does not state the device of a call; update it, or ask on the CPU")
    stream = _StreamArguments(ctypes.sizeof(_StreamArguments), None, frame.context, None)
    ordinal = _OrdinalArguments(ctypes.sizeof(_OrdinalArguments), None, frame.context, 0)
    failed = interface.get_stream(byref(stream)) or interface.get_ordinal(byref(ordinal))
    if failed:
        return failed
    points, nodes = (frame.arguments.at[i].contents for i in range(2))
    answer, moved = (frame.results.at[i].contents for i in range(2))
    count = math.prod(points.dims[:points.rank - 1])
    if count > 0 and moved.data != nodes.data:
        raise RuntimeError("nodes are expected to move in their own memory")
    if count > 0:
        _cuda.vessels(_model_of(frame.attributes), ordinal.ordinal).query(
            count, points.data, nodes.data, answer.data, stream=stream.stream or 0)
    return None


def _model_of(attributes):
    if attributes.count != 1 or attributes.types[0] != _SCALAR or attributes.at[0].contents.dtype != _S64:
        raise ValueError("found other attributes than a number of 64 bits")
    return _models[attributes.at[0].contents.value[0]]
