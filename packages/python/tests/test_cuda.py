# SPDX-License-Identifier: Apache-2.0
"""lumen._cuda on the stand-in for NVIDIA's driver, whose device is the memory of arrays of NumPy.

LUMEN_BLOB_CUDA_LIBRARY names libblob-cuda; LD_LIBRARY_PATH has the folder of the stand-in, libcuda.so.1."""
import ctypes
import gc
import os
import unittest

import numpy as np

from fixture import sample
from lumen import _cuda, blob

try:
    DRIVER = ctypes.CDLL("libcuda.so.1")
    HAS_STAND_IN = hasattr(DRIVER, "_ZN5lumen4blob4test8stand_in5resetEi")
except OSError:
    DRIVER, HAS_STAND_IN = None, False


def enter_context():
    """Makes the context of the stand-in current, as its streams need."""
    context = ctypes.c_void_p()
    DRIVER.cuInit(0)
    DRIVER.cuDevicePrimaryCtxRetain(ctypes.byref(context), 10)
    DRIVER.cuCtxPushCurrent_v2(context)


def model_and_points():
    model = blob.Model(sample().case)
    tree = sample().case.tree
    random = np.random.default_rng(3)
    node = random.integers(len(tree), size=2000)
    offset = random.uniform(-1.2, 1.2, (2000, 3))
    return model, (tree.centre[node] + tree.radius[node, None] * offset).astype(np.float32)


@unittest.skipUnless(HAS_STAND_IN and "LUMEN_BLOB_CUDA_LIBRARY" in os.environ,
                     "the stand-in for the driver or libblob-cuda is missing")
class CudaTest(unittest.TestCase):
    """Queries at addresses."""

    @classmethod
    def setUpClass(cls):
        cls.model, cls.points = model_and_points()
        cls.known = cls.model.cursor(cls.points).node.copy()
        enter_context()

    def setUp(self):
        self.nodes = self.known.copy()
        self.answer = np.full((len(self.points), 4), -7, np.float32)

    def query(self, **options):
        addresses = (array.ctypes.data for array in (self.points, self.nodes, self.answer))
        _cuda.vessels(self.model, 0).query(len(self.points), *addresses, **options)

    def expect_exact_answers(self):
        wanted = self.model.query(self.points, flags=blob.DISTANCE_EXACT)
        error = np.abs(self.answer[:, 0] - wanted.distance)
        self.assertGreater(np.mean(error < 1e-5), 0.995)
        np.testing.assert_array_equal(self.answer[:, 0] < 0, wanted.distance < 0)
        radius = sample().case.tree.radius[wanted.node]
        near = np.abs(wanted.distance) < 0.5 * radius  # towards the axis a normal is uncertain
        turned = np.abs(self.answer[:, 1:] - wanted.normal).max(axis=1)[near]
        self.assertLess(np.median(turned), 1e-5)
        self.assertGreater(np.mean(turned < 1e-3), 0.99)

    def test_answers_are_those_of_libblob(self):
        self.query()
        self.assertEqual(DRIVER.cuStreamSynchronize(None), 0)
        self.expect_exact_answers()

    def test_cursors_that_are_not_known_are_located(self):
        self.nodes[:] = 0xFFFFFFFF
        self.query()
        DRIVER.cuStreamSynchronize(None)
        np.testing.assert_array_equal(self.nodes, self.model.query(self.points, flags=blob.DISTANCE_EXACT).node)
        self.expect_exact_answers()

    def test_a_query_waits_in_its_stream(self):
        stream = ctypes.c_void_p()
        self.assertEqual(DRIVER.cuStreamCreate(ctypes.byref(stream), 0), 0)
        self.query(stream=stream.value)
        DRIVER.cuStreamSynchronize(None)
        self.assertTrue((self.answer == -7).all())
        DRIVER.cuStreamSynchronize(stream)
        self.expect_exact_answers()
        DRIVER.cuStreamDestroy_v2(stream)

    def test_flags_reach_the_query(self):
        self.query(flags=blob.BLENDED)
        DRIVER.cuStreamSynchronize(None)
        wanted = self.model.query(self.points, flags=blob.BLENDED)
        np.testing.assert_array_equal(self.answer[:, 0].astype(np.float64), wanted.distance)
        np.testing.assert_array_equal(self.nodes, wanted.node)

    def test_a_model_is_uploaded_once_and_freed_after_a_wait(self):
        model, waits = blob.Model(sample().case), []
        vessels = _cuda.vessels(model, 0, lambda: waits.append(1))
        self.assertIs(_cuda.vessels(model, 0), vessels)
        self.assertIsNot(_cuda.vessels(self.model, 0), vessels)
        count = len(_cuda._kept)  # pylint: disable=protected-access
        del model, vessels
        gc.collect()
        self.assertEqual((len(_cuda._kept), waits), (count - 1, [1]))  # pylint: disable=protected-access

    def test_what_the_device_refuses_is_an_error_with_its_reason(self):
        with self.assertRaisesRegex(RuntimeError, "there is no device 5 among 1"):
            _cuda.vessels(self.model, 5)
        with self.assertRaisesRegex(RuntimeError, "libblob-cuda: "):
            _cuda.Vessels(np.zeros(64, np.uint32), 0)
        with self.assertRaisesRegex(ValueError, "2\\^32"):
            _cuda.vessels(self.model, 0).query(1 << 32, 0, 0, 0)


class MissingTest(unittest.TestCase):
    def test_a_missing_library_is_an_error_that_says_what_to_do(self):
        before = os.environ.get("LUMEN_BLOB_CUDA_LIBRARY")
        os.environ["LUMEN_BLOB_CUDA_LIBRARY"] = "/absent/libblob-cuda.so.1"
        _cuda.library.cache_clear()
        try:
            with self.assertRaisesRegex(ImportError, "LUMEN_BLOB_CUDA_LIBRARY"):
                _cuda.library()
        finally:
            _cuda.library.cache_clear()
            del os.environ["LUMEN_BLOB_CUDA_LIBRARY"]
            if before is not None:
                os.environ["LUMEN_BLOB_CUDA_LIBRARY"] = before


if __name__ == "__main__":
    unittest.main()
