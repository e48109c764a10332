# SPDX-License-Identifier: Apache-2.0
"""Files that several pages use: a small tube with its seeds, its truth and its case."""
from fixtures import fixture


@fixture("tube.nrrd", "seeds.json", "truth.lumen")
def tube(store):
    """40^3 voxels of 0.2 mm: one vessel, 8 mm long, of 0.45 mm radius."""
    store.lumen("phantom", "tube", "tube.nrrd", "--size", "40", "--truth", "truth.lumen", "--seeds", "seeds.json")


@fixture("case.lumen")
def case(store):
    """The tube tracked and fitted."""
    store.path("tube.nrrd")
    store.lumen("convert", "tube.nrrd", "case.lumen", "--seeds", "seeds.json")


@fixture("mesh.glb")
def mesh(store):
    """The tube's surface."""
    store.path("case.lumen")
    store.lumen("convert", "case.lumen", "mesh.glb")


@fixture("empty.nrrd")
def empty(store):
    return b""
