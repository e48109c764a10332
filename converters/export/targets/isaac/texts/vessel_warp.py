# SPDX-License-Identifier: Apache-2.0
"""Distance, normal and inside test of the vessels for kernels of NVIDIA Warp, in place of a mesh query.

    wall = VesselWall()                                  # vessel_query.bin beside this file
    wall.query(points, cursor, distance, normal)         # arrays of Warp, in this folder's frame and unit

A kernel of your own takes `buffer` and `frame` of a VesselWall, and keeps a node for each point, its
cursor (NOWHERE at first), so that a tool stays in its vessel where two touch:

    depth, normal, node = vessel_distance(buffer, frame, x, cursor[i])

Depths are negative in the lumen. The field is that of the case, not of the mesh in vessel.usda.
"""
import json
import pathlib

import numpy as np
import warp as wp

from query_warp import *  # pylint: disable=wildcard-import,unused-wildcard-import

HERE = pathlib.Path(__file__).resolve().parent
NOWHERE = 0xFFFFFFFF

wp.set_module_options({"enable_backward": False})  # the query is not differentiated


@wp.struct
class VesselFrame:
    """Rows of the rotation from the case (mm, LPS) to this folder, and the folder's unit for a mm."""

    x: wp.vec3
    y: wp.vec3
    z: wp.vec3
    scale: wp.float32


@wp.func
def vessel_distance(buffer: wp.array(dtype=wp.uint32), frame: VesselFrame, x: wp.vec3,
                    cursor: wp.uint32):
    """Distance and outward normal at x in the folder's frame and unit, and the node that x belongs to."""
    at = wp.vec3()
    for k in range(3):
        at[k] = (frame.x[k] * x[0] + frame.y[k] * x[1] + frame.z[k] * x[2]) / frame.scale
    sample = blob_device_sample()
    node = cursor
    node, sample = blob_device_query(buffer, wp.uint32(0), wp.uint32(0), wp.uint32(0), at, node, sample)
    n = sample.normal
    normal = wp.vec3()
    normal[0] = frame.x[0] * n[0] + frame.x[1] * n[1] + frame.x[2] * n[2]
    normal[1] = frame.y[0] * n[0] + frame.y[1] * n[1] + frame.y[2] * n[2]
    normal[2] = frame.z[0] * n[0] + frame.z[1] * n[1] + frame.z[2] * n[2]
    return sample.distance * frame.scale, normal, node


@wp.kernel
def vessel_distances(
    buffer: wp.array(dtype=wp.uint32),
    frame: VesselFrame,
    point: wp.array(dtype=wp.vec3),
    cursor: wp.array(dtype=wp.uint32),
    distance: wp.array(dtype=wp.float32),
    normal: wp.array(dtype=wp.vec3),
):
    i = wp.tid()
    depth, outward, node = vessel_distance(buffer, frame, point[i], cursor[i])
    distance[i] = depth
    normal[i] = outward
    cursor[i] = node


class VesselWall:
    """The buffer and the frame of this folder, on a device of Warp."""

    def __init__(self, device=None):
        words = np.fromfile(HERE / "vessel_query.bin", "<u4")
        rows = np.array(json.loads((HERE / "lumen-export.json").read_text())["transform"])[:3, :3]
        self.buffer = wp.array(words, dtype=wp.uint32, device=device)
        self.frame = VesselFrame()
        self.frame.scale = wp.float32(np.linalg.norm(rows[0]))
        self.frame.x, self.frame.y, self.frame.z = (wp.vec3(*row) for row in rows / np.linalg.norm(rows[0]))

    def query(self, points, cursor, distance, normal):
        wp.launch(vessel_distances, dim=len(points), device=self.buffer.device,
                  inputs=[self.buffer, self.frame, points, cursor, distance, normal])
