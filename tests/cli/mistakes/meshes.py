# SPDX-License-Identifier: Apache-2.0
"""Files of docs/mistakes/meshes.md."""
import json, math, struct

from fixtures import fixture


def tube(radius, length, around=12, rings=6):
    """Corners of the triangles of a tube that is open at both ends."""
    ring = lambda r: [(radius * math.cos(2 * math.pi * a / around), radius * math.sin(2 * math.pi * a / around), length * r / rings)
                      for a in range(around)]
    for r in range(rings):
        low, high = ring(r), ring(r + 1)
        for a in range(around):
            b = (a + 1) % around
            yield low[a], low[b], high[a]
            yield low[b], high[b], high[a]


def stl(triangles, count=None):
    triangles = list(triangles)
    return (b"tube".ljust(80) + struct.pack("<I", len(triangles) if count is None else count)
            + b"".join(struct.pack("<12fH", 0, 0, 0, *a, *b, *c, 0) for a, b, c in triangles))


@fixture("half.stl")
def half(store):
    """A mesh of which only half was copied."""
    whole = stl(tube(2, 40))
    return whole[:len(whole) // 2]


@fixture("claim.stl")
def claim(store):
    """84 bytes that announce 200 GB."""
    return stl([], 0xFFFFFFFF)


@fixture("metres.stl")
def metres(store):
    """A tube of 8 mm in metres."""
    return stl(tube(0.008, 0.2))


@fixture("nan.obj")
def nan(store):
    return b"v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n"


@fixture("range.obj")
def beyond(store):
    return b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n"


@fixture("outside.gltf")
def outside(store):
    """Names a file of the system as its data."""
    return json.dumps({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 72, "uri": "../../../../etc/passwd"}]}).encode()


@fixture("grid.vtk")
def grid(store):
    return b"# vtk DataFile Version 3.0\nvolume mesh\nASCII\nDATASET UNSTRUCTURED_GRID\n"


@fixture("count.ply")
def count(store):
    return (b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1000000\n"
            b"property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")


@fixture("surface.dat")
def without_ending(store):
    return store.bytes("mesh.glb")
