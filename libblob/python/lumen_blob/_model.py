# SPDX-License-Identifier: Apache-2.0
import ctypes
import os
from typing import NamedTuple

import numpy as np

from ._library import lib

NOWHERE = 0xFFFFFFFF  #: a cursor that is not known: the query locates
BLENDED, LOCAL, DISTANCE_EXACT, HOLD = 0, 1, 2, 4  #: flags of queries
INSIDE, NOT_CONVERGED = 1, 2  #: bits of Answer.state

_NEAREST = np.dtype([("point", "f8", 3), ("normal", "f8", 3), ("distance", "f8"), ("node", "u4"),
                     ("steps", "u4"), ("converged", "i4")], align=True)
_HIT = np.dtype([("hit", "i4"), ("complete", "i4"), ("t", "f8"), ("point", "f8", 3),
                 ("normal", "f8", 3), ("node", "u4"), ("steps", "u4")], align=True)
_HESSIAN = np.dtype([("value", "f8"), ("gradient", "f8", 3), ("hessian", "f8", 6), ("mean_curvature", "f8"),
                     ("gaussian_curvature", "f8")], align=True)


class Error(Exception):
    """A model could not be opened; `status` is blob_status."""

    def __init__(self, status, message):
        super().__init__(message)
        self.status = status


class Answer(NamedTuple):
    """Facts at n points; the leading axis is missing for a single point."""
    value: np.ndarray     #: (n,) f, mm
    gradient: np.ndarray  #: (n, 3) of f, no unit; points inwards
    distance: np.ndarray  #: (n,) signed distance to the wall, mm, negative in the lumen
    normal: np.ndarray    #: (n, 3) outward unit normal
    state: np.ndarray     #: (n,) uint8, bits INSIDE and NOT_CONVERGED

    @property
    def inside(self):
        """(n,) bool: f above the iso-level."""
        return (self.state & INSIDE) != 0


class Nearest(NamedTuple):
    """The wall's nearest points to n points."""
    point: np.ndarray      #: (n, 3) mm
    normal: np.ndarray     #: (n, 3) outward, at `point`
    distance: np.ndarray   #: (n,) signed, mm
    converged: np.ndarray  #: (n,) bool; False: `point` is the best within the bound on steps


class Hessian(NamedTuple):
    """f and its derivatives at n points, in doubles throughout."""
    value: np.ndarray               #: (n,) f, mm
    gradient: np.ndarray            #: (n, 3) of f, no unit
    hessian: np.ndarray             #: (n, 6) xx, yy, zz, xy, xz, yz of f, 1/mm
    mean_curvature: np.ndarray      #: (n,) of the level set through the point, 1/mm
    gaussian_curvature: np.ndarray  #: (n,) 1/mm^2


class Hits(NamedTuple):
    """First crossings of the wall by n segments."""
    hit: np.ndarray       #: (n,) bool
    complete: np.ndarray  #: (n,) bool; False: steps ran out at t, up to which there is no crossing
    t: np.ndarray         #: (n,) share of the way
    point: np.ndarray     #: (n, 3) at t, mm
    normal: np.ndarray    #: (n, 3) outward, at `point`


class Model:
    """An immutable vessel tree with its blobs. Any number of threads may query it: ctypes lets go of the
    interpreter's lock during each call."""

    def __init__(self, source, verify=True):
        """Opens a .lumen file by its path, or from bytes. verify=False skips checksums. Raises Error."""
        self._handle = ctypes.c_void_p()
        definition = lib.blob_open_def_default()
        message = ctypes.create_string_buffer(500)
        definition.verify = int(verify)
        definition.message = ctypes.cast(message, ctypes.c_char_p)
        definition.message_size = len(message)
        if isinstance(source, (bytes, bytearray, memoryview)):
            data = bytes(source)
            status = lib.blob_model_open_bytes(data, len(data), definition, self._handle)
            name = "bytes"
        else:
            name = os.fsdecode(source)
            status = lib.blob_model_open(name.encode(), definition, self._handle)
        if status != 0:
            raise Error(status, f"{name}: {message.value.decode()}")
        self._info = lib.blob_model_describe(self._handle)

    def __del__(self):
        if getattr(self, "_handle", None):
            lib.blob_model_close(self._handle)
            self._handle = None

    def __len__(self):
        """The number of nodes."""
        return self._info.node_count

    @property
    def blob_count(self):
        return self._info.blob_count

    @property
    def iso_level(self):
        """T, mm."""
        return self._info.iso_level

    @property
    def bounds(self):
        """(2, 3) low and high corner of the box of the nodes' balls, mm."""
        return np.array([self._info.low, self._info.high])

    def nodes(self):
        """Centres (N, 3) in mm, radii (N,) in mm, and parents (N,) int32, -1 for none."""
        all_nodes = [lib.blob_model_node(self._handle, i) for i in range(len(self))]
        return (np.array([n.centre for n in all_nodes]).reshape(-1, 3),
                np.array([n.radius for n in all_nodes]),
                np.array([n.parent for n in all_nodes], dtype=np.int32))

    def cursors(self, points):
        """The node of least power of each of (n, 3) points in mm: (n,) uint32, to be kept by the caller
        and passed to every query. NOWHERE for a point that is not finite."""
        points, _ = _rows(points)
        cursors = np.full(len(points), NOWHERE, dtype=np.uint32)
        self.query(points, cursors, LOCAL | HOLD)
        return cursors

    def query(self, points, cursors=None, flags=BLENDED):
        """Answer at (n, 3) points in mm. `cursors`, (n,) uint32, are moved in place; None: each point is
        located, which costs more and may find a vessel that merely touches."""
        points, single = _rows(points)
        count = len(points)
        numbers = np.empty((8, count))
        state = np.empty(count, dtype=np.uint8)
        columns = lib.blob_columns_default()
        columns.count = count
        columns.point_stride = points.strides[0]
        columns.cursor = _cursor_address(cursors, count)
        columns.state = state.ctypes.data
        base = [numbers.ctypes.data + i * count * numbers.itemsize for i in range(8)]
        columns.value, columns.distance = base[0], base[4]
        for axis in range(3):
            columns.point[axis] = points.ctypes.data + axis * points.itemsize
            columns.gradient[axis], columns.normal[axis] = base[1 + axis], base[5 + axis]
        lib.blob_query_columns(self._handle, flags, columns)
        answer = Answer(numbers[0], numbers[1:4].T, numbers[4], numbers[5:8].T, state)
        return Answer(*(a[0] for a in answer)) if single else answer

    def nearest(self, points, cursors=None, flags=BLENDED, tolerance=0.0, max_steps=0):
        """Nearest points of the wall to (n, 3) points in mm, by Newton's method to `tolerance` mm (0: 1e-5
        of the node's radius)."""
        points, single = _rows(points)
        result = np.empty(len(points), dtype=_NEAREST)
        for address, cursor, out in zip(_addresses(points), _each(cursors, len(points)),
                                        _addresses(result)):
            lib.blob_nearest(self._handle, flags, address, cursor, tolerance, max_steps, out)
        rows = Nearest(result["point"], result["normal"], result["distance"], result["converged"] != 0)
        return Nearest(*(r[0] for r in rows)) if single else rows

    def hessian(self, points, cursors=None, flags=BLENDED):
        """Second derivatives of f at (n, 3) points in mm; several times slower than query()."""
        points, single = _rows(points)
        result = np.empty(len(points), dtype=_HESSIAN)
        for address, cursor, out in zip(_addresses(points), _each(cursors, len(points)), _addresses(result)):
            lib.blob_query_hessian(self._handle, flags, address, cursor, out)
        rows = Hessian(*(result[name] for name in Hessian._fields))
        return Hessian(*(r[0] for r in rows)) if single else rows

    def segment_hits(self, starts, ends, cursors=None, flags=BLENDED, tolerance=0.0):
        """First crossings of the wall on the way from (n, 3) `starts` to (n, 3) `ends`, mm. `cursors`
        belong to `starts`."""
        starts, single = _rows(starts)
        ends, _ = _rows(ends)
        if starts.shape != ends.shape:
            raise ValueError(f"starts {starts.shape} and ends {ends.shape} differ in shape")
        result = np.empty(len(starts), dtype=_HIT)
        for a, b, cursor, out in zip(_addresses(starts), _addresses(ends), _each(cursors, len(starts)),
                                     _addresses(result)):
            lib.blob_segment_hit(self._handle, flags, a, b, cursor, tolerance, 0, out)
        rows = Hits(result["hit"] != 0, result["complete"] != 0, result["t"], result["point"],
                    result["normal"])
        return Hits(*(r[0] for r in rows)) if single else rows


def pack(models):
    """One flat buffer of a sequence of models, (n,) uint32, for the queries of blob_device.h and blob_cuda.h. Raises
    ValueError without a model and for 16 GiB or more."""
    handles = (ctypes.c_void_p * len(models))(*(model._handle for model in models))
    size = lib.blob_device_pack(handles, len(models), None, 0)
    if size == 0:
        raise ValueError("models: expected at least one, and less than 16 GiB")
    words = np.empty(size // 4, np.uint32)
    if lib.blob_device_pack(handles, len(models), words.ctypes.data, size) != size:
        raise MemoryError(f"packed models: {size} bytes")
    return words


def _rows(points):
    """Points as packed (n, 3) doubles, and whether one alone was given."""
    points = np.ascontiguousarray(points, dtype=np.float64)
    if points.shape == (3,):
        return points.reshape(1, 3), True
    if points.ndim != 2 or points.shape[1] != 3:
        raise ValueError(f"points have shape {points.shape}; (n, 3) or (3,) was expected")
    return points, False


def _cursor_address(cursors, count):
    """Null for None. Cursors are written to, so they must be the caller's own memory."""
    if cursors is None:
        return None
    if not isinstance(cursors, np.ndarray) or cursors.dtype != np.uint32 or cursors.shape != (count,) \
            or not cursors.flags.c_contiguous or not cursors.flags.writeable:
        raise ValueError(f"cursors must be a packed, writable array of {count} uint32")
    return cursors.ctypes.data


def _each(cursors, count):
    address = _cursor_address(cursors, count)
    return [None if address is None else address + 4 * i for i in range(count)]


def _addresses(rows):
    return range(rows.ctypes.data, rows.ctypes.data + len(rows) * rows.strides[0], rows.strides[0])
