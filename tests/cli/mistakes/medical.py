# SPDX-License-Identifier: Apache-2.0
"""NIfTI and DICOM files of docs/mistakes/volumes.md."""
import gzip, struct

from fixtures import fixture


@fixture("tube.nii")
def tube(store):
    """A tube in NIfTI, 40^3 voxels of 0.2 mm."""
    store.lumen("phantom", "tube", "tube.nii", "--size", "40")


def changed(data, layout, at, *values):
    """The bytes with these numbers at a place."""
    data = bytearray(data)
    struct.pack_into(layout, data, at, *values)
    return bytes(data)


@fixture("copied.nii.gz")
def copied(store):
    """A compressed volume of which a part is missing in the middle."""
    whole = gzip.compress(store.bytes("tube.nii"), mtime=0)
    third = len(whole) // 3
    return whole[:third] + whole[third + 100:]


@fixture("no-unit.nii")
def no_unit(store):
    return changed(store.bytes("tube.nii"), "<b", 123, 0)


@fixture("no-spacing.nii")
def no_spacing(store):
    return changed(store.bytes("tube.nii"), "<3f", 80, 0, 0, 0)


@fixture("no-offset.nii")
def no_offset(store):
    return changed(store.bytes("tube.nii"), "<f", 108, 0)


@fixture("nowhere.nii")
def nowhere(store):
    """Its sform is of numbers that are none, its qform is not stated."""
    return changed(changed(store.bytes("tube.nii"), "<2h", 252, 0, 1), "<f", 280, float("nan"))


@fixture("moved.nii")
def moved(store):
    """Its qform is 5 mm from its sform."""
    return changed(store.bytes("tube.nii"), "<f", 268, 5)


@fixture("pair.hdr")
def pair(store):
    return changed(store.bytes("tube.nii"), "<4s", 344, b"ni1\0")[:352]


def element(group, number, kind, value):
    value = value.encode() if isinstance(value, str) else value
    value += b"\0" * (len(value) % 2) if kind == "UI" else b" " * (len(value) % 2)
    head = struct.pack("<HH2s", group, number, kind.encode())
    return head + (struct.pack("<HI" if kind == "OW" else "<H", *([0] if kind == "OW" else []), len(value))) + value


def short(group, number, value):
    return element(group, number, "US", struct.pack("<H", value))


def dicom(number, series="1.2.3.1", position=None, spacing="0.5\\0.5"):
    """A slice of 8 x 8 pixels, 1 mm from the next."""
    storage = "1.2.840.10008.5.1.4.1.1.2"
    meta = element(2, 2, "UI", storage) + element(2, 0x10, "UI", "1.2.840.10008.1.2.1")
    data = element(8, 0x16, "UI", storage) + element(8, 0x103e, "LO", "Angio " + series[-1])
    data += element(0x20, 0xe, "UI", series)
    data += element(0x20, 0x32, "DS", f"0\\0\\{number if position is None else position}")
    data += element(0x20, 0x37, "DS", "1\\0\\0\\0\\1\\0")
    data += short(0x28, 2, 1) + element(0x28, 4, "CS", "MONOCHROME2") + short(0x28, 0x10, 8) + short(0x28, 0x11, 8)
    data += element(0x28, 0x30, "DS", spacing) if spacing else b""
    data += short(0x28, 0x100, 16) + short(0x28, 0x101, 16) + short(0x28, 0x102, 15) + short(0x28, 0x103, 0)
    data += element(0x7fe0, 0x10, "OW", struct.pack("<64H", *range(number, number + 64)))
    return bytes(128) + b"DICM" + element(2, 0, "UL", struct.pack("<I", len(meta))) + meta + data


def folder(store, name, files):
    (store.folder / name).mkdir()
    for file, data in files.items():
        (store.folder / name / file).write_bytes(data)


@fixture("slice.dcm")
def single(store):
    return dicom(0)


@fixture("papers/")
def papers(store):
    folder(store, "papers", {"notes.txt": b"No image here.\n"})


@fixture("two-series/")
def two_series(store):
    folder(store, "two-series", {f"{s}{n}.dcm": dicom(n, f"1.2.3.{s}") for s in (1, 2) for n in range(4)})


@fixture("disc/")
def disc(store):
    """Two series in folders of their own."""
    (store.folder / "disc").mkdir()
    for s in (1, 2): folder(store, f"disc/SE{s}", {f"{n}.dcm": dicom(n, f"1.2.3.{s}") for n in range(4)})


@fixture("times.nii")
def times(store):
    """Two volumes in one file."""
    data = store.bytes("tube.nii")
    head = changed(data[:352], "<5h", 40, 4, *struct.unpack_from("<3h", data, 42), 2)
    return head + 2 * data[352:]


@fixture("gap/")
def gap(store):
    folder(store, "gap", {f"{n}.dcm": dicom(n) for n in range(8) if n != 3})


@fixture("broken/")
def broken(store):
    folder(store, "broken", {f"{n}.dcm": dicom(n)[:-60 if n == 2 else None] for n in range(4)})


@fixture("unscaled/")
def unscaled(store):
    folder(store, "unscaled", {f"{n}.dcm": dicom(n, spacing=None) for n in range(4)})


@fixture("one-slice/")
def one_slice(store):
    folder(store, "one-slice", {"1.dcm": dicom(1)})
