# SPDX-License-Identifier: Apache-2.0
"""Answers of a libblob.so to a fixed set of queries, as bytes; for hash_outputs.py.

Declares what it uses of blob.h itself, so that it works with the library of any build.
"""
import ctypes
import math
import pathlib
import random
import struct
from ctypes import POINTER, byref, c_char_p, c_double, c_int, c_int32, c_size_t, c_uint32, c_void_p

LOCAL, EXACT, HOLD = 1, 2, 4
FLAGS = {"blended": 0, "local": LOCAL, "hold": HOLD, "local-hold": LOCAL | HOLD, "exact": EXACT,
         "exact-local": EXACT | LOCAL}
PATHS = {"scalar": 1, "portable": 2, "avx2": 3, "avx512": 4}
NEEDS = {"avx2": {"avx2", "fma"}, "avx512": {"avx512f", "avx512dq", "avx512vl", "avx512bw"}}
NOWHERE = 0xFFFFFFFF
POINTS = 1500  # of a case, about
Point = c_double * 3


class OpenDef(ctypes.Structure):
    _fields_ = [("verify", c_int), ("simd", c_int), ("message", c_char_p),
                ("message_size", c_size_t), ("cookie", c_uint32)]


class Node(ctypes.Structure):
    _fields_ = [("centre", Point), ("radius", c_double), ("parent", c_int32)]


class Sample(ctypes.Structure):
    _fields_ = [("value", c_double), ("gradient", Point), ("distance", c_double),
                ("normal", Point), ("node", c_uint32), ("state", c_uint32)]


class Nearest(ctypes.Structure):
    _fields_ = [("point", Point), ("normal", Point), ("distance", c_double), ("node", c_uint32),
                ("steps", c_uint32), ("converged", c_int)]


class Hessian(ctypes.Structure):
    _fields_ = [("value", c_double), ("gradient", Point), ("hessian", c_double * 6),
                ("mean_curvature", c_double), ("gaussian_curvature", c_double)]


class Hit(ctypes.Structure):
    _fields_ = [("hit", c_int), ("complete", c_int), ("t", c_double), ("point", Point),
                ("normal", Point), ("node", c_uint32), ("steps", c_uint32)]


class Approach(ctypes.Structure):
    _fields_ = [("t", c_double), ("point", Point), ("distance", c_double), ("normal", Point),
                ("depth", c_double), ("node", c_uint32), ("state", c_uint32)]


class Columns(ctypes.Structure):
    _fields_ = [("count", c_size_t), ("point", c_void_p * 3), ("point_stride", ctypes.c_ssize_t),
                ("cursor", c_void_p), ("cursor_stride", ctypes.c_ssize_t), ("value", c_void_p),
                ("gradient", c_void_p * 3), ("distance", c_void_p), ("normal", c_void_p * 3),
                ("answer_stride", ctypes.c_ssize_t), ("state", c_void_p),
                ("state_stride", ctypes.c_ssize_t)]


def load(path):
    """The library with its functions declared; lib.hessian is that query by either of its names."""
    lib = ctypes.CDLL(str(pathlib.Path(path).resolve(strict=True)))
    model, flags, point, cursor = c_void_p, c_uint32, POINTER(c_double), POINTER(c_uint32)
    lib.hessian = getattr(lib, "blob_query_hessian", None) or lib.blob_query_second
    declarations = {
        "blob_open_def_default": (OpenDef, []),
        "blob_model_open": (c_int, [c_char_p, POINTER(OpenDef), POINTER(c_void_p)]),
        "blob_model_close": (None, [model]),
        "blob_model_node": (Node, [model, c_uint32]),
        "blob_model_neighbours": (c_size_t, [model, c_uint32, c_void_p, c_size_t]),
        "blob_cursor_locate": (c_uint32, [model, point]),
        "blob_cursor_follow": (c_uint32, [model, point, c_uint32]),
        "blob_query": (None, [model, flags, point, cursor, c_void_p]),
        "blob_query_many": (None, [model, flags, c_size_t, c_void_p, c_void_p, c_void_p]),
        "blob_columns_default": (Columns, []),
        "blob_query_columns": (None, [model, flags, POINTER(Columns)]),
        "blob_inside": (c_int, [model, flags, point, cursor]),
        "blob_nearest": (None, [model, flags, point, cursor, c_double, c_uint32, c_void_p]),
        "hessian": (None, [model, flags, point, cursor, c_void_p]),
        "blob_segment_hit": (None, [model, flags, point, point, cursor, c_double, c_uint32,
                                    c_void_p]),
        "blob_capsule_approach": (None, [model, flags, point, point, c_double, cursor, c_void_p]),
    }
    for name, (result, parameters) in declarations.items():
        function = getattr(lib, name)
        function.restype, function.argtypes = result, parameters
    return lib


def paths():
    """The SIMD paths of this processor, by name."""
    try:
        cpu = set(pathlib.Path("/proc/cpuinfo").read_text(encoding="ascii").split())
    except OSError:
        cpu = set()
    return {name: value for name, value in PATHS.items() if NEEDS.get(name, set()) <= cpu}


def packed(value):
    """The fields of a structure, one after another, without padding; every NaN the same."""
    if isinstance(value, ctypes.Structure):
        return b"".join(packed(getattr(value, name)) for name, _ in value._fields_)
    if isinstance(value, (ctypes.Array, list)):
        return b"".join(packed(item) for item in value)
    if isinstance(value, float):
        return struct.pack("<d", math.nan if math.isnan(value) else value)
    return struct.pack("<q", value)


class Case:
    """One file, opened on one path, and the points that it is asked about."""

    def __init__(self, lib, file, simd):
        self.lib, self.model = lib, c_void_p()
        definition = lib.blob_open_def_default()
        definition.simd = simd
        self.status = lib.blob_model_open(str(file).encode(), byref(definition), byref(self.model))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.lib.blob_model_close(self.model)

    def nodes(self):
        """All nodes in order: the first that does not exist has a radius of NaN."""
        found = []
        while not math.isnan((node := self.lib.blob_model_node(self.model, len(found))).radius):
            found.append(node)
        return found

    def choose_points(self):
        """Points about evenly chosen nodes, up to 2.2 radii away in each axis; the node of each."""
        nodes, numbers = self.nodes(), random.Random(1)
        step = max(1, 4 * len(nodes) // POINTS)
        self.points, self.starts = [], []
        for i in range(0, len(nodes), step):
            for _ in range(4):
                reach = 2.2 * nodes[i].radius
                self.points.append(Point(*(c + (2 * numbers.random() - 1) * reach
                                           for c in nodes[i].centre)))
                self.starts.append(i)
        for odd in (math.nan, math.inf, -math.inf, 1e9):
            self.points.append(Point(0.0, odd, 1.0))
            self.starts.append(0)
        self.radii = [nodes[i].radius for i in self.starts]

    def each(self, answer_type, ask):
        """ask(point, cursor, answer, i) for every point, one cursor following from first to last."""
        out, cursor = [], c_uint32(NOWHERE)
        for i, point in enumerate(self.points):
            answer = answer_type()
            ask(point, byref(cursor), byref(answer), i)
            out.append(packed(answer) if isinstance(answer, ctypes.Structure)
                       else packed(answer.value))
            out.append(packed(cursor.value))
        return b"".join(out)


def neighbours(case):
    room = (c_uint32 * 256)()
    out = []
    for i in range(len(case.nodes())):
        count = case.lib.blob_model_neighbours(case.model, i, room, 256)
        out.append(packed([count, *room[:min(count, 256)]]))
    return b"".join(out)


def cursors(case):
    lib, model = case.lib, case.model
    return packed([lib.blob_cursor_locate(model, p) for p in case.points] +
                  [lib.blob_cursor_follow(model, p, s) for p, s in zip(case.points, case.starts)])


def batch(case, flags):
    count = len(case.points)
    points, starts = (Point * count)(*case.points), (c_uint32 * count)(*case.starts)
    samples = (Sample * count)()
    case.lib.blob_query_many(case.model, flags, count, points, starts, samples)
    return packed(samples) + packed(starts)


def columns(case, flags):
    """All answers as columns of doubles, points located."""
    count, asked = len(case.points), case.lib.blob_columns_default()
    data = [(c_double * count)() for _ in range(11)]
    state = (ctypes.c_uint8 * count)()
    for i, point in enumerate(case.points):
        data[0][i], data[1][i], data[2][i] = point
    address = [ctypes.addressof(column) for column in data]
    asked.count, asked.value, asked.distance = count, address[3], address[4]
    asked.point[:], asked.gradient[:], asked.normal[:] = address[:3], address[5:8], address[8:]
    asked.state = ctypes.addressof(state)
    case.lib.blob_query_columns(case.model, flags, byref(asked))
    return packed(data) + packed(list(state))


def ask_inside(case, flags):
    def ask(point, cursor, answer, _):
        answer._obj.value = case.lib.blob_inside(case.model, flags, point, cursor)
    return case.each(c_int, ask)


def ask_with_end(case, answer_type, call):
    """Queries of the way from each point to the next but one that is finite."""
    ends = case.points[2:] + case.points[:2]
    return case.each(answer_type, lambda p, cursor, answer, i: call(p, ends[i], cursor, answer, i))


def answers(lib, file):
    """Pairs of a name and bytes: what the case answers on each path."""
    for path, simd in paths().items():
        with Case(lib, file, simd) as case:
            if case.status != 0:
                yield f"{path}/status", packed(case.status)
                continue
            case.choose_points()
            for name, data in on_path(case):
                yield f"{path}/{name}", data


def on_path(case):
    lib, model = case.lib, case.model
    yield "nodes", packed(case.nodes())
    yield "neighbours", neighbours(case)
    yield "cursors", cursors(case)
    for name, flags in FLAGS.items():
        yield f"one-{name}", case.each(
            Sample, lambda p, c, a, _, f=flags: lib.blob_query(model, f, p, c, a))
        yield f"many-{name}", batch(case, flags)
        yield f"columns-{name}", columns(case, flags)
    for name, flags in (("blended", 0), ("local", LOCAL), ("hold", HOLD)):
        yield f"inside-{name}", ask_inside(case, flags)
        yield f"nearest-{name}", case.each(
            Nearest, lambda p, c, a, _, f=flags: lib.blob_nearest(model, f, p, c, 0.0, 0, a))
        yield f"hessian-{name}", case.each(
            Hessian, lambda p, c, a, _, f=flags: lib.hessian(model, f, p, c, a))
        yield f"segments-{name}", ask_with_end(
            case, Hit, lambda p, q, c, a, _, f=flags: lib.blob_segment_hit(
                model, f, p, q, c, 0.0, 0, a))
        yield f"capsules-{name}", ask_with_end(
            case, Approach, lambda p, q, c, a, i, f=flags: lib.blob_capsule_approach(
                model, f, p, q, 0.3 * case.radii[i], c, a))


def opening(lib, file):
    """The status of opening a file, by the best path."""
    with Case(lib, file, 0) as case:
        return packed(case.status)
