# SPDX-License-Identifier: Apache-2.0
"""Files of docs/mistakes/volumes.md."""
from fixtures import fixture


@fixture("half.nrrd")
def half(store):
    """The tube, of which only half was copied."""
    whole = store.bytes("tube.nrrd")
    return whole[:len(whole) // 2]


def raw(header, voxels=bytes(range(8))):
    """A small volume: the lines of its header, and what follows them."""
    return "\n".join(header).encode() + b"\n" + voxels


def nrrd(*lines, voxels=bytes(range(8))):
    """An NRRD file of 2 x 2 x 2 bytes."""
    return raw(["NRRD0004", "type: uint8", "dimension: 3", "sizes: 2 2 2", *lines, "encoding: raw", ""], voxels)


def meta(*lines, data="LOCAL", voxels=bytes(range(8))):
    """A MetaImage file of 2 x 2 x 2 bytes."""
    return raw(["NDims = 3", *lines, "DimSize = 2 2 2", "ElementType = MET_UCHAR", f"ElementDataFile = {data}"], voxels)


@fixture("unspaced.nrrd")
def unspaced(store):
    return nrrd()


@fixture("metres.nrrd")
def metres(store):
    """A spacing in metres, without a word of it."""
    return nrrd("spacings: 0.0005 0.0005 0.0005")


@fixture("feet.nrrd")
def feet(store):
    """A unit that nobody scans in."""
    return nrrd("spacings: 1 1 1", 'units: "foot" "foot" "foot"')


@fixture("minus.mha")
def minus(store):
    return meta("ElementSpacing = 1 -1 1")


@fixture("sheared.mha")
def sheared(store):
    return meta("ElementSpacing = 1 1 1", "TransformMatrix = 1 0 0 0.1 0.995 0 0 0 1")


@fixture("long.mha")
def long(store):
    """One number of DimSize is too small."""
    return meta("ElementSpacing = 1 1 1", voxels=bytes(range(12)))


@fixture("moved.mhd")
def moved(store):
    """Its voxels have stayed elsewhere."""
    return meta("ElementSpacing = 1 1 1", data="moved.raw", voxels=b"")


@fixture("outside.mhd")
def outside(store):
    return meta("ElementSpacing = 1 1 1", data="/etc/passwd", voxels=b"")


@fixture("slices.mhd")
def slices(store):
    """Two slices, but three names."""
    return meta("ElementSpacing = 1 1 1", data="slice%d.raw 1 3 1", voxels=b"")


@fixture("twice.mha")
def twice(store):
    return meta("ElementSpacing = 1 1 1", "Offset = 0 0 0", "Position = 0 0 5")


@fixture("colour.nrrd")
def colour(store):
    """A picture in colour, not a scan."""
    return raw(["NRRD0004", "type: uint8", "dimension: 4", "sizes: 3 2 2 2", "kinds: RGB-color domain domain domain",
                "encoding: raw", ""], bytes(range(24)))


@fixture("flat.nrrd")
def flat(store):
    return raw(["NRRD0004", "type: uint8", "dimension: 2", "sizes: 4 2", "encoding: raw", ""])
