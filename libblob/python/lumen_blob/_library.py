# SPDX-License-Identifier: Apache-2.0
"""blob.h for ctypes: structures, functions, and where the shared library is."""
import ctypes
import ctypes.util
import os
from ctypes import (POINTER, c_char_p, c_double, c_int, c_int32, c_size_t, c_ssize_t, c_uint32,
                    c_void_p)


class OpenDef(ctypes.Structure):
    _fields_ = [("verify", c_int), ("simd", c_int), ("message", c_char_p), ("message_size", c_size_t),
                ("cookie", c_uint32)]


class Info(ctypes.Structure):
    _fields_ = [("node_count", c_size_t), ("blob_count", c_size_t), ("kernel", c_int),
                ("kernel_parameter", c_double), ("iso_level", c_double),
                ("simd", c_int), ("low", c_double * 3), ("high", c_double * 3), ("bytes", c_size_t)]


class Node(ctypes.Structure):
    _fields_ = [("centre", c_double * 3), ("radius", c_double), ("parent", c_int32)]


class Columns(ctypes.Structure):
    _fields_ = [("count", c_size_t), ("point", c_void_p * 3), ("point_stride", c_ssize_t),
                ("cursor", c_void_p), ("cursor_stride", c_ssize_t), ("value", c_void_p),
                ("gradient", c_void_p * 3), ("distance", c_void_p), ("normal", c_void_p * 3),
                ("answer_stride", c_ssize_t), ("state", c_void_p), ("state_stride", c_ssize_t)]


def _find():
    """LUMEN_BLOB_LIBRARY names the file; else the library beside this package, else the system's."""
    here = os.path.join(os.path.dirname(__file__), "libblob.so")
    named = os.environ.get("LUMEN_BLOB_LIBRARY")
    for path in (named, here if os.path.exists(here) else None, ctypes.util.find_library("blob")):
        if path:
            return ctypes.CDLL(path)
    raise ImportError("libblob not found: install it, or set LUMEN_BLOB_LIBRARY to its path")


def _declare(lib):
    model = c_void_p
    declarations = {
        "blob_status_text": (c_char_p, [c_int]),
        "blob_open_def_default": (OpenDef, []),
        "blob_model_open": (c_int, [c_char_p, POINTER(OpenDef), POINTER(model)]),
        "blob_model_open_bytes": (c_int, [c_char_p, c_size_t, POINTER(OpenDef), POINTER(model)]),
        "blob_model_close": (None, [model]),
        "blob_model_describe": (Info, [model]),
        "blob_model_node": (Node, [model, c_uint32]),
        "blob_columns_default": (Columns, []),
        "blob_query_columns": (None, [model, c_uint32, POINTER(Columns)]),
        "blob_query_hessian": (None, [model, c_uint32, c_void_p, c_void_p, c_void_p]),
        "blob_device_pack": (c_size_t, [POINTER(model), c_size_t, c_void_p, c_size_t]),
        "blob_nearest": (None, [model, c_uint32, c_void_p, c_void_p, c_double, c_uint32, c_void_p]),
        "blob_segment_hit": (None, [model, c_uint32, c_void_p, c_void_p, c_void_p, c_double, c_uint32,
                                    c_void_p]),
    }
    for name, (result, arguments) in declarations.items():
        function = getattr(lib, name)
        function.restype, function.argtypes = result, arguments
    return lib


lib = _declare(_find())
