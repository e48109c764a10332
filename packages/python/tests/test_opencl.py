# SPDX-License-Identifier: Apache-2.0
"""A packed model and the sources of the package, as a program in Python uses them through OpenCL."""
import unittest

import numpy as np

try:
    import pyopencl
    DEVICES = [device for platform in pyopencl.get_platforms() for device in platform.get_devices()]
except Exception:  # pyopencl.LogicError where there is no platform, whose class is missing with the package
    pyopencl, DEVICES = None, []

from fixture import sample
from lumen import blob


class OpenClTest(unittest.TestCase):
    def test_all_sources_are_there(self):
        names = {path.name for path in blob.device_sources().iterdir()}
        self.assertEqual(names, {"blob_device.h", "blob_device_batch.h", "blob_device_blend.h", "blob_device_exact.h",
                                 "blob_device_lanes.h", "blob_device_load.h", "blob_device_model.h", "blob_device_simt.h",
                                 "blob_device_wall.h", "blob_device_wide.h", "query.cl", "query.cu", "query.wgsl"})

    @unittest.skipIf(not DEVICES, "pyopencl (Debian: python3-pyopencl) or a device (pocl-opencl-icd) is missing")
    def test_answers_are_those_of_libblob(self):
        model = blob.Model(sample().case)
        tree = sample().case.tree
        random = np.random.default_rng(5)
        node = random.integers(len(tree), size=20000)
        points = (tree.centre[node] + tree.radius[node, None] * random.uniform(-1.5, 1.5, (20000, 3))).astype(np.float32)
        cursor = model.cursor(points)

        context = pyopencl.Context(DEVICES[:1])
        queue = pyopencl.CommandQueue(context)
        program = pyopencl.Program(context, (blob.device_sources() / "query.cl").read_text(encoding="utf-8"))
        kernel = program.build(["-cl-std=CL1.2", "-I", str(blob.device_sources())]).blob_query_points
        there = [pyopencl.Buffer(context, pyopencl.mem_flags.READ_WRITE | pyopencl.mem_flags.COPY_HOST_PTR, hostbuf=array)
                 for array in (blob.pack(model), points, cursor.node.copy())]
        answer = np.empty((len(points), 4), np.float32)  # distance, normal
        out = pyopencl.Buffer(context, pyopencl.mem_flags.WRITE_ONLY, answer.nbytes)
        kernel(queue, (len(points),), None, there[0], *map(np.uint32, (0, blob.BLENDED, len(points))), *there[1:], out, None, None)
        pyopencl.enqueue_copy(queue, answer, out)

        wanted = model.query(points, cursor)
        scale = np.maximum(tree.radius[wanted.node], wanted.distance)
        self.assertLess(np.max(np.abs(answer[:, 0] - wanted.distance) / scale), 1e-5)
        self.assertGreater(wanted.inside.sum(), 1000)


if __name__ == "__main__":
    unittest.main()
