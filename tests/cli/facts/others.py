# SPDX-License-Identifier: Apache-2.0
"""The same voxels, lines and triangles as libraries of others write them, as far as these are installed."""
import importlib, math, pathlib, tempfile

import lines, meshes, volumes
from turned import AXIS_ALIGNED, Turned, grid, turn_name, turns


def modules(*names):
    """The modules, or none if one is missing."""
    try: return [importlib.import_module(name) for name in names]
    except ImportError: return None


def written(name, write, *more):
    """Contents of the files that `write(path)` makes, the one of this name first."""
    with tempfile.TemporaryDirectory() as folder:
        write(str(pathlib.Path(folder, name)))
        made = {p.name: p.read_bytes() for p in pathlib.Path(folder).iterdir()}
    return {name: made.pop(name), **made}


def voxels(np, g, kind):
    return np.array(g.values, kind).reshape(g.size[::-1])  # k, j, i


def affine(np, g):
    m = np.eye(4)
    axes, origin = g.ras()
    for a in range(3): m[:3, a] = np.array(axes[a]) * g.spacing[a]
    m[:3, 3] = origin
    return m


def by_nibabel(g, original, where):
    found = modules("numpy", "nibabel")
    if not found: return
    np, nib = found
    data = voxels(np, g, "uint8").transpose(2, 1, 0)
    for fact, code in (("qform and sform", (1, 1)), ("qform", (1, 0)), ("sform", (0, 1)), ("aligned sform", (0, 2))):
        for unit, k in (("mm", 1), ("meter", 1e-3), ("micron", 1e3)):
            m = affine(np, g)
            m[:3] *= k
            image = nib.Nifti1Image(data, None)
            image.set_qform(m, code[0])
            image.set_sform(m, code[1])
            image.header.set_xyzt_units(unit)
            yield Turned("NIfTI", f"nibabel, {fact}, {unit}; {where}", written("v.nii.gz", lambda path: nib.save(image, path)), original=original)
    for kind in ("int16", "uint16", "int32", "float32", "float64"):
        image = nib.Nifti1Image(data.astype(kind), affine(np, g))
        image.header.set_xyzt_units("mm")
        image.header.set_slope_inter(1, 0)
        yield Turned("NIfTI", f"nibabel, {kind}; {where}", written("v.nii", lambda path: nib.save(image, path)), original=original)
        image.header.set_slope_inter(0.25, -3)
        yield Turned("NIfTI", f"nibabel, {kind}, a scale; {where}", written("v.nii", lambda path: nib.save(image, path)), "warned", "as in a mask", (), original)
    # SPM's masks: NaN outside; what programs leave where they divided by 0
    for none in (np.nan, np.inf, -np.inf):
        image = nib.Nifti1Image(np.where(data == 0, none, data).astype("float32"), affine(np, g))
        image.header.set_xyzt_units("mm")
        yield Turned("NIfTI", f"nibabel, {none} around; {where}", written("v.nii.gz", lambda path: nib.save(image, path)), words="not finite", original=original)
    image = nib.Nifti2Image(data, affine(np, g))
    yield Turned("NIfTI", f"nibabel, NIfTI-2; {where}", written("v.nii", lambda path: nib.save(image, path)), "refused", "NIfTI-1", (), original)
    image = nib.Nifti1Pair(data, affine(np, g))
    yield Turned("NIfTI", f"nibabel, a pair; {where}", written("v.hdr", lambda path: nib.save(image, path)), "refused", r"\.nii", (), original)
    image = nib.AnalyzeImage(data, affine(np, g))
    yield Turned("NIfTI", f"nibabel, ANALYZE; {where}", written("v.hdr", lambda path: nib.save(image, path)), "refused", r"nii", (), original)


def leaning(original):
    """Slices under a gantry tilt of `lean` degrees, as nibabel writes their affine, the sform alone (dicom2nifti, dcm2niix)."""
    found = modules("numpy", "nibabel")
    if not found: return
    np, nib = found
    for degrees in (-20, -10, 10, 20, 30):
        lean = math.tan(math.radians(degrees))
        low = (-24.0, 10.0 - max(lean, 0) * 16, 40.0)
        g = grid((*AXIS_ALIGNED[:2], (0, lean / math.hypot(lean, 1), 1 / math.hypot(lean, 1))), (56, 80, 60), (0.25, 0.25, 0.35), low)
        data = voxels(np, g, "int16").transpose(2, 1, 0)
        for what, values in (("", data), (", -1 around", np.where(data == 0, -1, data)), (", floats", (data * 0.99999994).astype("float32")),
                             (", NaN around", np.where(data == 0, np.nan, data).astype("float32"))):
            image = nib.Nifti1Image(values, None)
            image.set_sform(affine(np, g), 2)
            image.header.set_xyzt_units("mm")
            yield Turned("NIfTI", f"nibabel, a tilt of {degrees} degrees{what}", written("v.nii", lambda path: nib.save(image, path)),
                         words="its axes lean", original=original, isTurned=True)


def by_simpleitk(g, original, where):
    found = modules("numpy", "SimpleITK")
    if not found: return
    np, sitk = found
    for kind in ("uint8", "int16", "uint16", "float32", "float64", "int32"):
        image = sitk.GetImageFromArray(voxels(np, g, kind))
        image.SetSpacing([float(s) for s in g.spacing])
        image.SetOrigin([float(x) for x in g.origin])
        image.SetDirection([float(g.axes[c][r]) for r in range(3) for c in range(3)])
        for name in ("v.nii", "v.nii.gz", "v.nrrd", "v.nhdr", "v.mha", "v.mhd"):
            for packed in (False, True):
                yield Turned({"n": "NIfTI" if "nii" in name else "NRRD", "m": "MetaImage"}[name[2]], f"SimpleITK, {name} {kind} {packed}; {where}",
                             written(name, lambda path: sitk.WriteImage(image, path, packed)), original=original)
    for name in ("v.vtk", "v.hdr", "v.gipl", "v.tif", "v.mnc"):
        try: files = written(name, lambda path: sitk.WriteImage(sitk.Cast(image, sitk.sitkUInt16), path))
        except Exception: continue
        yield Turned("other volumes", f"SimpleITK, {name}; {where}", files, "refused", r"nrrd|\.nii|POLYDATA", (), original)


def by_pynrrd(g, original, where):
    found = modules("numpy", "nrrd")
    if not found: return
    np, nrrd = found
    data = voxels(np, g, "int16")
    for space, signs in (("left-posterior-superior", (1, 1, 1)), ("right-anterior-superior", (-1, -1, 1)), ("left-anterior-superior", (1, -1, 1))):
        for encoding in ("raw", "gzip", "ascii"):
            for order in ("F", "C"):
                head = {"space": space, "space directions": [[s * x * d for s, x in zip(signs, a)] for a, d in zip(g.axes, g.spacing)],
                        "space origin": [s * x for s, x in zip(signs, g.origin)], "kinds": ["domain"] * 3, "encoding": encoding, "space units": ["mm"] * 3}
                if order == "C": head["space directions"] = head["space directions"][::-1]
                array = data.transpose(2, 1, 0) if order == "F" else data.transpose(2, 1, 0).transpose(2, 1, 0)
                if order == "C": head["space directions"] = head["space directions"][::-1]; array = data.transpose(2, 1, 0).copy(order="C")
                yield Turned("NRRD", f"pynrrd, {space} {encoding} {order}; {where}", written("v.nrrd", lambda path: nrrd.write(path, array, head)), original=original)
    yield Turned("NRRD", f"pynrrd, detached; {where}", written("v.nhdr", lambda path: nrrd.write(path, data.transpose(2, 1, 0), head, detached_header=True)), original=original)


def by_meshio(original):
    found = modules("numpy", "meshio")
    if not found: return
    np, meshio = found
    mesh = meshio.Mesh(np.array(meshes.POINTS), [("triangle", np.array(meshes.FACES))])
    for name, how in (("m.stl", {}), ("m.stl", {"binary": True}), ("m.ply", {}), ("m.ply", {"binary": False}), ("m.obj", {}), ("m.vtk", {}), ("m.vtk", {"binary": False})):
        try: files = written(name, lambda path: meshio.write(path, mesh, **how))
        except Exception: continue
        yield Turned("meshes of others", f"meshio, {name} {how}", files, *(("refused", "PolyData|POLYDATA") if name == "m.vtk" else ()), original=original)


def by_trimesh(original):
    found = modules("numpy", "trimesh")
    if not found: return
    np, trimesh = found
    mesh = trimesh.Trimesh(np.array(meshes.POINTS), np.array(meshes.FACES), process=False)
    for name in ("m.stl", "m.ply", "m.obj"):
        yield Turned("meshes of others", f"trimesh, {name}", written(name, lambda path: mesh.export(path)), original=original)
    up = trimesh.Trimesh(np.array(meshes.up(meshes.POINTS)), np.array(meshes.FACES), process=False)
    for name in ("m.glb", "m.gltf"):
        files = written(name, lambda path: up.export(path)) if name == "m.glb" else {"m.gltf": None, **up.export(file_type="gltf")}
        if name == "m.gltf": files["m.gltf"] = files.pop("model.gltf")
        yield Turned("meshes of others", f"trimesh, {name}", files, original=original)
    for k, unit in ((1000, "mm"), (100, "cm")):  # as programs do that do not ask for metres
        plain = trimesh.Trimesh(np.array(meshes.up(meshes.placed(k=k / 1000))) * 1000, np.array(meshes.FACES), process=False)
        files = written("m.glb", lambda path: plain.export(path))
        yield Turned("meshes of others", f"trimesh, m.glb in {unit}", files, "warned", "--unit", (), original)
        yield Turned("meshes of others", f"trimesh, m.glb in {unit}, stated", files, options=("--unit", unit), original=original)
    yield Turned("meshes of others", "trimesh, m.3mf", written("m.3mf", lambda path: mesh.export(path)), "refused", "STL or OBJ", (), original)


def by_vtk(of_meshes, of_lines):
    found = modules("vtkmodules.vtkCommonCore", "vtkmodules.vtkCommonDataModel", "vtkmodules.vtkIOXML", "vtkmodules.vtkIOLegacy", "vtkmodules.vtkIOGeometry", "vtkmodules.vtkIOPLY")
    if not found: return
    core, model, xml, legacy, geometry, plyio = found

    def data(points, cells, radii=None, **texts):
        poly, places, array = model.vtkPolyData(), core.vtkPoints(), model.vtkCellArray()
        places.SetDataTypeToDouble()
        for p in points: places.InsertNextPoint(*p)
        for cell in cells:
            array.InsertNextCell(len(cell))
            for i in cell: array.InsertCellPoint(i)
        poly.SetPoints(places)
        (poly.SetLines if radii else poly.SetPolys)(array)
        if radii:
            values = core.vtkDoubleArray()
            values.SetName("MaximumInscribedSphereRadius")
            for r in radii: values.InsertNextValue(r)
            poly.GetPointData().AddArray(values)
        for name, value in texts.items():
            text = core.vtkStringArray()
            text.SetName(name)
            text.InsertNextValue(value)
            poly.GetFieldData().AddArray(text)
        return poly
    def of_lines_with(signs, k, texts):
        points, radii, cells = lines.line_data(lines.scaled(lines.LINES, k, signs))
        return data(points, cells, radii, **texts)

    def of_triangles_with(signs, k, texts):
        return data([tuple(s * k * x for s, x in zip(signs, p)) for p in meshes.POINTS], meshes.FACES, **texts)

    def xml_by(poly, mode, packer, header):
        def write(path):
            w = xml.vtkXMLPolyDataWriter()
            getattr(w, "SetDataModeTo" + mode.removesuffix("Raw"))()
            if mode.endswith("Raw"): w.EncodeAppendedDataOff()
            getattr(w, f"SetCompressorTypeTo{packer}")()
            getattr(w, f"SetHeaderTypeTo{header}")()
            w.SetInputData(poly)
            w.SetFileName(path)
            w.Write()
        return written("c.vtp", write)

    def legacy_by(poly, binary):
        def write(path):
            w = legacy.vtkPolyDataWriter()
            (w.SetFileTypeToBinary if binary else w.SetFileTypeToASCII)()
            w.SetInputData(poly)
            w.SetFileName(path)
            w.Write()
        return written("c.vtk", write)
    stated = (((1, 1, 1), 1, {}), ((-1, -1, 1), 1, {"SPACE": "RAS"}), ((1, 1, 1), 1, {"SPACE": "LPS"}), ((-1, -1, 1), 0.1, {"SPACE": "RAS", "Unit": "cm"}))
    for what, original, make in (("lines", of_lines, of_lines_with), ("triangles", of_meshes, of_triangles_with)):
        for signs, k, texts in stated:
            poly, facts = make(signs, k, texts), f"of {what} {' '.join(texts.values())}"
            for mode in ("Ascii", "Binary", "Appended", "AppendedRaw"):
                for packer in ("None", "ZLib"):
                    for header in ("UInt32", "UInt64"):
                        yield Turned("VTK of others", f"VTK, XML {facts} {mode} {packer} {header}", xml_by(poly, mode, packer, header), original=original)
            yield Turned("VTK of others", f"VTK, XML {facts} LZ4", xml_by(poly, "Appended", "LZ4", "UInt32"), "refused", "vtkZLibDataCompressor", (), original)
            for binary in (False, True):
                yield Turned("VTK of others", f"VTK, legacy {facts} {binary}", legacy_by(poly, binary), original=original)


def by_pydicom(g, original, where):
    """A series of this grid, a slice for each file; a left-handed grid's slices are numbered from its other end."""
    found = modules("numpy", "pydicom", "pydicom.dataset", "pydicom.uid")
    if not found: return
    np, pydicom, dataset, uid = found
    data = voxels(np, g, "int16")

    def series(explicit=True, slope=None, inter=0, order=1, signed=True, thickness=None, big=False, number=True, gap_field=False):
        files = {}
        root = uid.generate_uid(entropy_srcs=[where])[:40] + "1"
        for k in range(g.size[2]):
            ds = dataset.Dataset()
            ds.file_meta = dataset.FileMetaDataset()
            ds.file_meta.TransferSyntaxUID = uid.ExplicitVRBigEndian if big else uid.ExplicitVRLittleEndian if explicit else uid.ImplicitVRLittleEndian
            ds.file_meta.MediaStorageSOPClassUID = ds.SOPClassUID = "1.2.840.10008.5.1.4.1.1.2"
            ds.file_meta.MediaStorageSOPInstanceUID = ds.SOPInstanceUID = f"{root}.{k + 1}"
            ds.SeriesInstanceUID, ds.StudyInstanceUID, ds.FrameOfReferenceUID, ds.Modality = root, root + ".1", root + ".2", "CT"
            ds.Rows, ds.Columns, ds.PixelSpacing = g.size[1], g.size[0], [g.spacing[1], g.spacing[0]]
            ds.ImageOrientationPatient = [f"{x:.9g}"[:16] for x in (*g.axes[0], *g.axes[1])]
            ds.ImagePositionPatient = [f"{o + k * g.spacing[2] * a:.9g}" for o, a in zip(g.origin, g.axes[2])]
            if number: ds.InstanceNumber = k + 1 if order > 0 else g.size[2] - k
            if thickness: ds.SliceThickness = thickness
            if gap_field: ds.SpacingBetweenSlices = 3 * g.spacing[2]
            ds.SamplesPerPixel, ds.PhotometricInterpretation, ds.BitsAllocated, ds.BitsStored, ds.HighBit, ds.PixelRepresentation = 1, "MONOCHROME2", 16, 16, 15, int(signed)
            stored = data[k]
            if slope: ds.RescaleSlope, ds.RescaleIntercept = slope, inter; stored = ((data[k] - inter) / slope)
            ds.PixelData = stored.astype((">" if big else "<") + ("i2" if signed else "u2")).tobytes()
            files[f"{'IMG' if order > 0 else 'Z'}{(k if order > 0 else g.size[2] - k):04d}"] = written("x", lambda path: pydicom.dcmwrite(path, ds, enforce_file_format=True, implicit_vr=not explicit, little_endian=not big))["x"]
        return files
    for fact, how in (("explicit", {}), ("implicit", {"explicit": False}), ("a slope and an intercept", {"slope": 0.5, "inter": -1000}),
                      ("numbered backwards", {"order": -1}), ("without numbers", {"number": False}), ("unsigned", {"signed": False}),
                      ("a thickness of 3 mm", {"thickness": 3}), ("a wrong SpacingBetweenSlices", {"gap_field": True})):
        yield Turned("DICOM", f"pydicom, {fact}; {where}", {f"series/{name}": content for name, content in series(**how).items()}, original=original)


def others(grids):
    for lattice, g in grids.items():
        for n, turn in enumerate(turns()):
            if n % 11: continue
            at, where = g.turned(*turn), f"{lattice}, {turn_name(turn)}"
            original = Turned("NRRD", f"LPS; {where}", volumes.nrrd(at))
            for made in (by_nibabel, by_simpleitk, by_pynrrd): yield from made(at, original, where)
            # a stack of DICOM has its slices in the order of its right-handed normal
            a, b, c = at.axes
            if sum((a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3]) * c[i] for i in range(3)) > 0: yield from by_pydicom(at, original, where)
    of_meshes, of_lines = Turned("STL", "mm, LPS", {"m.stl": meshes.stl()}), Turned("SWC", "mm, LPS", {"c.swc": lines.swc()})
    for made in (by_meshio, by_trimesh): yield from made(of_meshes)
    yield from leaning(Turned("NRRD", f"LPS; aligned, {turn_name(turns()[0])}", volumes.nrrd(grids["aligned"])))
    yield from by_vtk(of_meshes, of_lines)
