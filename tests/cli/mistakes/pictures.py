# SPDX-License-Identifier: Apache-2.0
"""Files of docs/mistakes/pictures.md."""
from fixtures import fixture


@fixture("pictures.png/")
def folder(store):
    (store.folder / "pictures.png").mkdir()


@fixture("line.lumen")
def of_a_centerline(store):
    """A case of a centerline, which no volume is known of."""
    (store.folder / "line.swc").write_text("".join(f"{i + 1} 3 {i} 0 0 1 {i or -1}\n" for i in range(10)))
    store.lumen("convert", "line.swc", "line.lumen")


@fixture("elsewhere.nrrd")
def elsewhere(store):
    """The tube, a metre away."""
    header, voxels = store.bytes("tube.nrrd").split(b"\n\n", 1)
    lines = [b"space origin: (1000,0,0)" if line.startswith(b"space origin") else line for line in header.split(b"\n")]
    return b"\n".join(lines) + b"\n\n" + voxels
