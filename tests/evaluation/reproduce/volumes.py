# SPDX-License-Identifier: Apache-2.0
"""Volumes in NumPy: reads NRRD, MetaImage and NIfTI, and writes the same voxels in each container and as DICOM. Needs
python3-nibabel and python3-pydicom."""
import gzip
import zlib

import nibabel
import numpy
import pydicom
from pydicom.dataset import FileDataset, FileMetaDataset
from pydicom.uid import ExplicitVRLittleEndian, generate_uid

KINDS = {"uint8": "u1", "short": "<i2", "int16": "<i2", "uint16": "<u2", "ushort": "<u2", "float": "<f4", "MET_FLOAT": "<f4",
         "MET_SHORT": "<i2", "MET_UCHAR": "u1", "unsigned char": "u1"}


class Volume:
    """Voxels (x fastest, Fortran order), and the affine from voxel numbers to LPS, mm."""

    def __init__(self, voxels, affine):
        self.voxels, self.affine = voxels, affine


def read_text_header(file):
    """Fields of NRRD or MetaImage, and the bytes of their voxels."""
    data = file.read_bytes()
    nrrd = data.startswith(b"NRRD")
    end = data.index(b"\n\n") + 2 if nrrd else data.index(b"\n", data.index(b"ElementDataFile")) + 1
    lines = [line for line in data[:end].decode().splitlines() if not line.startswith("#")]
    mark = ":" if nrrd else "="
    fields = {key.strip(): value.strip() for key, value in (line.split(mark, 1) for line in lines if mark in line)}
    return nrrd, fields, data[end:]


def read(file):
    if file.suffix == ".nii":
        image = nibabel.load(file)
        return Volume(numpy.asarray(image.dataobj), numpy.diag([-1, -1, 1, 1]) @ image.affine)
    nrrd, fields, data = read_text_header(file)
    numbers = lambda key: [float(x) for x in fields[key].translate(str.maketrans("(),", "   ")).split()]
    affine = numpy.eye(4)
    if nrrd:
        if fields["encoding"] in ("gzip", "gz"): data = gzip.decompress(data)
        affine[:3, :3] = numpy.array(numbers("space directions")).reshape(3, 3).T
        affine[:3, 3] = numbers("space origin")
        kind, shape = fields["type"], [int(n) for n in numbers("sizes")]
    else:
        if fields.get("CompressedData") == "True": data = zlib.decompress(data)
        axes = numpy.array(numbers("TransformMatrix")).reshape(3, 3).T
        affine[:3, :3] = axes * numbers("ElementSpacing")
        affine[:3, 3] = numbers("Offset")
        kind, shape = fields["ElementType"], [int(n) for n in numbers("DimSize")]
    return Volume(numpy.frombuffer(data, KINDS[kind]).reshape(shape, order="F"), affine)


def write_nrrd(volume, file, move=0.0):
    kind = {"uint8": "uint8", "int16": "int16", "uint16": "uint16", "float32": "float"}[volume.voxels.dtype.name]
    columns = [",".join(repr(float(x)) for x in column) for column in volume.affine[:3, :3].T]
    origin = ",".join(repr(float(x)) for x in volume.affine[:3, 3] + move)
    head = (f"NRRD0004\ntype: {kind}\ndimension: 3\nspace: left-posterior-superior\nsizes: {' '.join(map(str, volume.voxels.shape))}\n"
            f"space directions: ({') ('.join(columns)})\nkinds: domain domain domain\nendian: little\nencoding: raw\nspace origin: ({origin})\n\n")
    file.write_bytes(head.encode() + volume.voxels.tobytes(order="F"))


def write_metaimage(volume, file):
    kind = {"uint8": "MET_UCHAR", "int16": "MET_SHORT", "uint16": "MET_USHORT", "float32": "MET_FLOAT"}[volume.voxels.dtype.name]
    spacing = numpy.linalg.norm(volume.affine[:3, :3], axis=0)
    text = lambda values: " ".join(repr(float(x)) for x in values)
    file.write_bytes((f"ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nCompressedData = False\n"
                      f"TransformMatrix = {text((volume.affine[:3, :3] / spacing).T.ravel())}\nOffset = {text(volume.affine[:3, 3])}\n"
                      f"ElementSpacing = {text(spacing)}\nDimSize = {' '.join(map(str, volume.voxels.shape))}\nElementType = {kind}\n"
                      "ElementDataFile = LOCAL\n").encode() + volume.voxels.tobytes(order="F"))


def write_nifti(volume, file):
    image = nibabel.Nifti1Image(volume.voxels, numpy.diag([-1, -1, 1, 1]) @ volume.affine)
    image.header.set_xyzt_units("mm")
    nibabel.save(image, file)


def write_dicom(volume, folder):
    """One file for each slice; voxels are whole numbers of at most 16 bits. The patient's name is that of a phantom."""
    folder.mkdir()
    spacing = numpy.linalg.norm(volume.affine[:3, :3], axis=0)
    axes = volume.affine[:3, :3] / spacing
    series, study, frame = generate_uid(), generate_uid(), generate_uid()
    decimal = lambda value: f"{value:.10g}"[:16]
    for k in range(volume.voxels.shape[2]):
        meta = FileMetaDataset()
        meta.MediaStorageSOPClassUID = pydicom.uid.CTImageStorage
        meta.MediaStorageSOPInstanceUID = generate_uid()
        meta.TransferSyntaxUID = ExplicitVRLittleEndian
        slice_ = FileDataset("", {}, file_meta=meta, preamble=b"\0" * 128)
        slice_.is_little_endian, slice_.is_implicit_VR = True, False
        slice_.SOPClassUID, slice_.SOPInstanceUID = meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID
        slice_.SeriesInstanceUID, slice_.StudyInstanceUID, slice_.FrameOfReferenceUID = series, study, frame
        slice_.PatientName, slice_.PatientID, slice_.Modality, slice_.InstanceNumber = "Phantom", "0", "CT", k + 1
        slice_.Columns, slice_.Rows = volume.voxels.shape[:2]
        slice_.PixelSpacing = [decimal(spacing[1]), decimal(spacing[0])]
        slice_.ImageOrientationPatient = [decimal(x) for x in (*axes[:, 0], *axes[:, 1])]
        slice_.ImagePositionPatient = [decimal(x) for x in (volume.affine @ [0, 0, k, 1])[:3]]
        slice_.SliceThickness = decimal(spacing[2])
        slice_.SamplesPerPixel, slice_.PhotometricInterpretation = 1, "MONOCHROME2"
        slice_.BitsAllocated = slice_.BitsStored = 16
        slice_.HighBit, slice_.PixelRepresentation = 15, 1
        slice_.RescaleIntercept, slice_.RescaleSlope = "0", "1"
        slice_.PixelData = volume.voxels[:, :, k].astype("<i2").tobytes(order="F")
        slice_.save_as(folder / f"{k:04}.dcm")
