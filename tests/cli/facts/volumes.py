# SPDX-License-Identifier: Apache-2.0
"""Voxels as NIfTI, NRRD and MetaImage, each stated fact turned one at a time."""
import bz2, gzip, math, struct, zlib

from turned import Turned, turn_name, turns

CODES = {"B": 2, "h": 4, "i": 8, "f": 16, "d": 64, "b": 256, "H": 512, "I": 768, "q": 1024, "Q": 1280}


def packed(values, code="B", endian="<"):
    return struct.pack(f"{endian}{len(values)}{code}", *values)


# NIfTI -----------------------------------------------------------------------------------------

def quaternion(axes):
    """b, c, d and the handedness of the rotation whose columns are `axes`."""
    (a, d, g), (b, e, h), (c, f, i) = axes  # columns
    det = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
    if det < 0: c, f, i = -c, -f, -i
    w = [1 + a + e + i, 1 + a - e - i, 1 - a + e - i, 1 - a - e + i]
    best = max(range(4), key=lambda n: w[n])
    s = 2 * math.sqrt(w[best])
    q = ([s / 4, (h - f) / s, (c - g) / s, (d - b) / s], [(h - f) / s, s / 4, (b + d) / s, (c + g) / s],
         [(c - g) / s, (b + d) / s, s / 4, (f + h) / s], [(d - b) / s, (c + g) / s, (f + h) / s, s / 4])[best]
    if q[0] < 0: q = [-x for x in q]
    return q[1:], -1.0 if det < 0 else 1.0


def nifti(g, q=1, s=1, unit=2, scale=1.0, endian="<", code="B", values=None, slope=1.0, inter=0.0, dims=None, offset=352,
          pixdim=None, extension=b"", q_frame=None, s_frame=None, magic=b"n+1\0", handedness=None):
    """`scale`: file units in a mm. `q_frame`, `s_frame`: axes and origin, RAS mm, other than those of the grid."""
    axes, origin = q_frame or g.ras()
    s_axes, s_origin = s_frame or g.ras()
    (b, c, d), hand = quaternion(axes)
    h = bytearray(348)
    put = lambda at, form, *v: struct.pack_into(endian + form, h, at, *v)
    put(0, "i", 348)
    put(40, "8h", *(dims or (3, *g.size, 1, 1, 1, 1)))
    put(70, "2h", CODES[code], 8 * struct.calcsize(code))
    put(76, "8f", hand if handedness is None else handedness, *(pixdim or [x * scale for x in g.spacing]), 0, 0, 0, 0)
    put(108, "3f", offset, slope, inter)
    h[123] = unit
    put(252, "2h", q, s)
    put(256, "6f", b, c, d, *(x * scale for x in origin))
    for r in range(3):
        put(280 + 16 * r, "4f", *(s_axes[a][r] * g.spacing[a] * scale for a in range(3)), s_origin[r] * scale)
    h[344:348] = magic
    return bytes(h) + (extension or b"\0\0\0\0") + packed(g.values if values is None else values, code, endian)


def niftis(g, original):
    def turned(fact, answer="same", words="", file="v.nii", options=(), pack=bytes, **how):
        return Turned("NIfTI", fact, {file: pack(nifti(g, **how))}, answer, words, options, original)
    moved = (g.ras()[0], tuple(x + 7 for x in g.ras()[1]))
    mirrored = ([(-a[0], *a[1:]) for a in g.ras()[0]], g.ras()[1])
    yield turned("qform and sform")
    yield turned("qform alone", s=0)
    yield turned("sform alone", q=0, q_frame=moved)
    yield turned("sform of code 2 alone", q=0, s=2, q_frame=moved)
    yield turned("qform of another place, code 0", q=0, q_frame=mirrored)
    yield turned("sform of another place, code 0", s=0, s_frame=mirrored)
    yield turned("both disagree, equal codes", "warned", "place voxels up to", q_frame=moved)
    yield turned("both disagree, the qform's code is higher", "warned", "place voxels up to", q=2, s_frame=moved)
    yield turned("neither", "warned", "places it nowhere", q=0, s=0)
    yield turned("handedness 0", **({"handedness": 0.0} if quaternion(g.ras()[0])[1] > 0 else {}))
    yield turned("metres", unit=1, scale=1e-3)
    yield turned("micrometres", unit=3, scale=1e3)
    yield turned("mm and seconds", unit=2 | 8)
    yield turned("mm and milliseconds", unit=2 | 16)
    yield turned("no unit", "same", "no unit of length", unit=0)
    yield turned("metres without a unit", "warned", "unit", unit=0, scale=1e-3)
    yield turned("metres by an option", unit=0, scale=1e-3, options=("--unit", "m"))
    yield turned("big-endian", endian=">")
    yield turned("big-endian shorts", endian=">", code="h")
    for code in "bhHiIqQfd": yield turned(f"type {code}", code=code)
    yield turned("compressed", file="v.nii.gz", pack=gzip.compress)
    yield turned("compressed, under the name of plain", pack=gzip.compress)
    yield turned("plain, under the name of compressed", file="v.nii.gz")
    yield turned("slope 0", slope=0.0)
    yield turned("slope 0.5", slope=0.5, values=[2 * v for v in g.values])
    yield turned("intercept -1", inter=-1.0, values=[v + 1 for v in g.values])
    yield turned("slope -1, intercept 1", slope=-1.0, inter=1.0, values=[1 - v for v in g.values])
    yield turned("slope not a number", "same", "not a number", slope=math.nan, inter=math.nan)
    yield turned("a time of one volume", dims=(4, *g.size, 1, 1, 1, 1))
    yield turned("two volumes, the second", dims=(4, *g.size, 2, 1, 1, 1), values=[0] * len(g.values) + g.values,
                 options=("--volume-index", "1"))
    yield turned("two volumes", "refused", "volume-index", dims=(4, *g.size, 2, 1, 1, 1), values=g.values * 2)
    yield turned("a fifth axis", dims=(5, *g.size, 1, 1, 1, 1))
    yield turned("offset of 368 with an extension", offset=368, extension=b"\1\0\0\0" + struct.pack("<2i8x", 16, 6))
    yield turned("negative pixdim", "refused", "--spacing", pixdim=[-x for x in g.spacing])
    yield turned("pixdim 0", "refused", "--spacing", pixdim=[0, 0, 0])
    yield turned("pixdim of other units than the sform", "warned", "pixdim", pixdim=[x / 10 for x in g.spacing])
    yield turned("of a pair", "refused", r"\.nii", magic=b"ni1\0")
    yield Turned("NIfTI", "version 2", {"v.nii": struct.pack("<i", 540) + bytes(600)}, "refused", "NIfTI-1", (), original)
    sheared = ([g.ras()[0][0], tuple(y + 0.2 * x for x, y in zip(g.ras()[0][0], g.ras()[0][1])), g.ras()[0][2]], g.ras()[1])
    yield turned("sheared sform", "warned", "lean", s_frame=sheared)


# NRRD ------------------------------------------------------------------------------------------

SPACES = {"left-posterior-superior": (1, 1, 1), "LPS": (1, 1, 1), "right-anterior-superior": (-1, -1, 1), "RAS": (-1, -1, 1),
          "left-anterior-superior": (1, -1, 1), "LAS": (1, -1, 1), "Left-Posterior-Superior": (1, 1, 1)}
TYPES = {"uchar": "B", "unsigned char": "B", "uint8": "B", "uint8_t": "B", "signed char": "b", "int8": "b", "short": "h",
         "short int": "h", "signed short": "h", "int16_t": "h", "ushort": "H", "uint16": "H", "int": "i", "signed int": "i",
         "int32": "i", "uint": "I", "uint32_t": "I", "longlong": "q", "int64": "q", "ulonglong": "Q", "uint64_t": "Q",
         "float": "f", "double": "d"}
FIELDS = "type dimension space sizes kinds endian encoding"


def vector(values):
    return "(" + ",".join(repr(float(v)) for v in values) + ")"


def nrrd(g, space="left-posterior-superior", kind="uchar", encoding="raw", endian="<", scale=1.0, values=None, lines=(),
         before=b"", detached=None, without=(), pack=bytes, fields=None, magic="NRRD0004"):
    """`fields`: replaces lines of the header by name, `lines`: more of them."""
    to = SPACES.get(space, (1, 1, 1))
    values = g.values if values is None else values
    head = {"type": kind, "dimension": "3", "space": space, "sizes": " ".join(map(str, g.size)),
            "space directions": " ".join(vector(t * x * s * scale for t, x in zip(to, a)) for a, s in zip(g.axes, g.spacing)),
            "kinds": "domain domain domain", "endian": "little" if endian == "<" else "big", "encoding": encoding,
            "space origin": vector(t * x * scale for t, x in zip(to, g.origin))}
    head.update(fields or {})
    text = magic + "\n" + "".join(f"{k}: {v}\n" for k, v in head.items() if k not in without) + "".join(f"{x}\n" for x in lines)
    if encoding in ("ascii", "text", "txt"): body = " ".join(map(str, values)).encode()
    elif encoding == "hex": body = packed(values).hex().encode()
    else: body = packed(values, TYPES[kind], endian)
    if encoding in ("gzip", "gz"): body = gzip.compress(body)
    if encoding in ("bzip2", "bz2"): body = bz2.compress(body)
    body = before + body
    if detached is None: return {"v.nrrd": text.encode() + b"\n" + body}
    if detached == "slices":
        n = len(body) // g.size[2]
        named = {f"s{k:03d}.raw": body[k * n:(k + 1) * n] for k in range(g.size[2])}
        return {"v.nhdr": (text + f"data file: s%03d.raw 0 {g.size[2] - 1} 1\n").encode(), **named}
    if detached == "list":
        n = len(body) // g.size[2]
        named = {f"t{g.size[2] - k}.raw": body[k * n:(k + 1) * n] for k in range(g.size[2])}
        return {"v.nhdr": (text + "data file: LIST\n" + "\n".join(named) + "\n").encode(), **named}
    return {"v.nhdr": (text + f"data file: {detached}\n").encode(), detached: body}


def nrrds(g, original):
    aligned = all(a[i] == 1 for i, a in enumerate(g.axes))

    def turned(fact, answer="same", words="", options=(), **how):
        return Turned("NRRD", fact, nrrd(g, **how), answer, words, options, original)
    for space in SPACES: yield turned(f"space {space}", space=space)
    for space in ("scanner-xyz", "3D-right-handed", "3D-left-handed"): yield turned(f"space {space}", "warned", "space", space=space)
    yield turned("space dimension 3", "same", "states no space", without=("space",), fields={"space dimension": "3"})
    yield turned("no space", "refused", "no space", without=("space",))
    for kind in TYPES: yield turned(f"type {kind}", kind=kind)
    for kind in ("short", "float"): yield turned(f"big-endian {kind}", kind=kind, endian=">")
    yield turned("short without endian", "refused", "endian", kind="short", without=("endian",))
    for encoding in ("gzip", "gz", "ascii", "text", "txt", "hex"): yield turned(f"encoding {encoding}", encoding=encoding)
    for encoding in ("bzip2", "bz2"): yield turned(f"encoding {encoding}", "refused", "gzip|unu", encoding=encoding)
    for unit, scale in (("mm", 1), ("cm", 0.1), ("m", 1e-3), ("um", 1e3), ("microns", 1e3), ("millimeters", 1)):
        yield turned(f"space units {unit}", scale=scale, lines=('space units: ' + ' '.join([f'"{unit}"'] * 3),))
    yield turned("space units that differ", "refused", "--unit", lines=('space units: "mm" "mm" "cm"',))
    yield turned("space units unknown", "same", "space units", lines=('space units: "px" "px" "px"',))
    yield turned("units beside directions", scale=0.1, lines=('units: "cm" "cm" "cm"',))
    yield turned("thicknesses", lines=("thicknesses: 3 3 3",))
    yield turned("centers node", lines=("centers: node node node",))
    yield turned("centerings cell", lines=("centerings: cell cell cell",))
    yield turned("measurement frame", lines=("measurement frame: (0,1,0) (1,0,0) (0,0,-1)",))
    yield turned("comments and keys", lines=("# space: RAS", "spacing:=3 3 3", "DistanceUnits:=cm"))
    yield turned("fields in another order", fields={"space": "right-anterior-superior"}, space="RAS")
    yield turned("byte skip 7", before=b"seven--", lines=("byte skip: 7",))
    yield turned("byte skip -1", before=b"any number", lines=("byte skip: -1",))
    yield turned("line skip 2", before=b"two\nlines\n", lines=("line skip: 2",))
    yield turned("lineskip and byteskip", before=b"one\nabc", lines=("lineskip: 1", "byteskip: 3"))
    yield turned("detached", detached="v.raw")
    yield turned("detached, compressed", detached="v.raw.gz", encoding="gzip")
    yield turned("detached, big-endian", detached="v.raw", kind="short", endian=">")
    yield turned("detached, slices by a pattern", detached="slices")
    yield turned("detached, slices by a list", detached="list")
    yield turned("detached, byte skip -1", detached="v.raw", before=b"head", lines=("byte skip: -1",))
    yield turned("version 1", magic="NRRD0001")
    yield turned("version 5", magic="NRRD0005")
    yield turned("no kinds", without=("kinds",))
    yield turned("kinds space", fields={"kinds": "space space space"})
    yield turned("old min and old max", "warned", "old m", lines=("old min: 0", "old max: 2000"))
    directions = nrrd(g)["v.nrrd"].split(b"space directions: ")[1].split(b"\n")[0].decode()
    yield turned("a component axis first", fields={"dimension": "4", "sizes": "1 " + " ".join(map(str, g.size)),
                 "kinds": "list domain domain domain", "space directions": f"none {directions}"})
    yield turned("two volumes first, the second", fields={"dimension": "4", "sizes": "2 " + " ".join(map(str, g.size)),
                 "kinds": "list domain domain domain", "space directions": f"none {directions}"},
                 values=[x for v in g.values for x in (0, v)], options=("--volume-index", "1"))
    yield turned("two volumes last, the first", fields={"dimension": "4", "sizes": " ".join(map(str, g.size)) + " 2",
                 "kinds": "domain domain domain list", "space directions": f"{directions} none"},
                 values=g.values + [0] * len(g.values), options=("--volume-index", "0"))
    yield turned("space with time", fields={"dimension": "4", "sizes": " ".join(map(str, g.size)) + " 1",
                 "space": "left-posterior-superior-time", "kinds": "domain domain domain time",
                 "space directions": directions.replace(")", ",0)") + " (0,0,0,1)",
                 "space origin": vector(g.origin)[:-1] + ",0)"})
    if not aligned: return
    without = ("space directions", "space origin")
    spacings, mins = " ".join(map(str, g.spacing)), [o - s / 2 for o, s in zip(g.origin, g.spacing)]
    yield turned("spacings and origin", without=without[:1], lines=(f"spacings: {spacings}",))
    yield turned("spacings and axis mins", without=without, lines=(f"spacings: {spacings}", "axis mins: " + " ".join(map(str, mins))))
    yield turned("axis mins and maxs", without=without, lines=("axis mins: " + " ".join(map(str, mins)), "axis maxs: " +
                 " ".join(str(m + n * s) for m, n, s in zip(mins, g.size, g.spacing))))
    yield turned("axis mins and maxs of nodes", without=without, lines=("centers: node node node", "axis mins: " +
                 " ".join(map(str, g.origin)), "axis maxs: " + " ".join(str(o + (n - 1) * s) for o, n, s in zip(g.origin, g.size, g.spacing))))
    yield turned("axis maxs below mins", "refused", "spacing", without=without, lines=("axis mins: 10 10 10", "axis maxs: 0 0 0"))
    yield turned("units of spacings", without=without[:1], scale=0.1, lines=("spacings: " + " ".join(str(s / 10) for s in g.spacing),
                 'units: "cm" "cm" "cm"'))
    yield turned("spacings beside directions", "refused", "one of them", lines=(f"spacings: {spacings}",))
    yield turned("negative spacings", "refused", "--spacing", without=without[:1], lines=("spacings: -0.5 0.5 0.5",))
    yield turned("no spacing", "warned", "no spacing", without=without[:1])


# MetaImage -------------------------------------------------------------------------------------

META = {"MET_UCHAR": "B", "MET_CHAR": "b", "MET_SHORT": "h", "MET_USHORT": "H", "MET_INT": "i", "MET_UINT": "I",
        "MET_LONG_LONG": "q", "MET_FLOAT": "f", "MET_DOUBLE": "d"}


def meta(g, kind="MET_UCHAR", endian="<", scale=1.0, values=None, names=None, lines=(), data="LOCAL", compressed=False,
         text=False, before=b"", without=(), size=None, dims=3, sized=True):
    """`names`: other names of fields; `lines`: more lines."""
    values = g.values if values is None else values
    more = [0] * (dims - 3)
    square = [list(a) + more for a in g.axes] + [[int(r == c) for c in range(dims)] for r in range(3, dims)]
    body = " ".join(map(str, values)).encode() if text else packed(values, META[kind], endian)
    if compressed: body = zlib.compress(body)
    join = lambda numbers: " ".join(repr(float(n)) for n in numbers)
    head = {"ObjectType": "Image", "NDims": dims, "BinaryData": str(not text), "BinaryDataByteOrderMSB": str(endian == ">"),
            "CompressedData": str(compressed), "CompressedDataSize": len(body) if compressed and sized else None,
            "TransformMatrix": join(x for row in square for x in row), "Offset": join([x * scale for x in g.origin] + more),
            "ElementSpacing": join([s * scale for s in g.spacing] + [1] * len(more)),
            "DimSize": " ".join(map(str, size or g.size)), "ElementType": kind}
    names = names or {}
    lines_of = [f"{names.get(k, k)} = {v}" for k, v in head.items() if v is not None and k not in without]
    header = "\n".join(lines_of + list(lines) + [f"ElementDataFile = {data}"]) + "\n"
    body = before + body
    if data == "LOCAL": return {"v.mha": header.encode() + body}
    n = len(body) // g.size[2]
    parts = [body[k * n:(k + 1) * n] for k in range(g.size[2])]
    if data == "LIST":
        named = {f"t{g.size[2] - k}.raw": part for k, part in enumerate(parts)}
        return {"v.mhd": (header + "\n".join(named) + "\n").encode(), **named}
    if "%" in data: return {"v.mhd": header.encode(), **{data.split()[0] % (k + 1): part for k, part in enumerate(parts)}}
    return {"v.mhd": header.encode(), data: body}


def orientation(axes):
    """MetaIO's letters of axes that run along those of the patient: the side that each one comes from, as ITK writes them."""
    return "".join(("RL", "AP", "IS")[r][a[r] < 0] for a in axes for r in range(3) if abs(a[r]) > 0.8)


def metas(g, original):
    def turned(fact, answer="same", words="", options=(), **how):
        return Turned("MetaImage", fact, meta(g, **how), answer, words, options, original)
    for matrix in ("TransformMatrix", "Rotation", "Orientation"): yield turned(matrix, names={"TransformMatrix": matrix})
    for origin in ("Offset", "Position", "Origin"): yield turned(origin, names={"Offset": origin})
    yield turned("ElementSize instead of ElementSpacing", names={"ElementSpacing": "ElementSize"})
    yield turned("ElementSize of another size", lines=("ElementSize = 1 1 1",))
    letters = orientation(g.axes)
    yield turned("AnatomicalOrientation as ITK writes it", lines=(f"AnatomicalOrientation = {letters}",))
    yield turned("AnatomicalOrientation as MetaIO defines it", lines=(f"AnatomicalOrientation = {letters.translate(str.maketrans('RLAPIS', 'LRPASI'))}",))
    yield turned("AnatomicalOrientation of another frame", "same", "AnatomicalOrientation", lines=(f"AnatomicalOrientation = {letters[1:] + letters[0]}",))
    yield turned("AnatomicalOrientation without a matrix", "warned", "AnatomicalOrientation", without=("TransformMatrix",), lines=("AnatomicalOrientation = LPI",))
    yield turned("AnatomicalOrientation unknown", lines=("AnatomicalOrientation = ???",))
    yield turned("CenterOfRotation", lines=("CenterOfRotation = 3 4 5",))
    for endian, field in ((">", "ElementByteOrderMSB"), ("<", "ElementByteOrderMSB"), (">", "BinaryDataByteOrderMSB")):
        yield turned(f"{field} {endian == '>'}", kind="MET_SHORT", endian=endian, names={"BinaryDataByteOrderMSB": field})
    yield turned("two byte orders", "refused", "twice", kind="MET_SHORT", lines=("ElementByteOrderMSB = True",))
    for kind in META: yield turned(kind, kind=kind)
    yield turned("compressed", compressed=True)
    yield turned("compressed, no size stated", compressed=True, sized=False)
    yield turned("compressed, detached", compressed=True, data="v.zraw")
    yield turned("text", text=True)
    yield turned("detached", data="v.raw")
    yield turned("slices of a list", data="LIST")
    yield turned("slices of a pattern", data="s%03d.raw")
    yield turned("HeaderSize -1", data="v.raw", before=b"head", lines=("HeaderSize = -1",))
    yield turned("HeaderSize 4", data="v.raw", before=b"head", lines=("HeaderSize = 4",))
    yield turned("key in small letters", names={"TransformMatrix": "transformmatrix", "Offset": "offset"})
    for unit, scale in (("mm", 1), ("cm", 0.1), ("m", 1e-3), ("um", 1e3)):
        yield turned(f"DistanceUnits {unit}", scale=scale, lines=(f"DistanceUnits = {unit}",))
    yield turned("DistanceUnits unknown", "same", "DistanceUnits", lines=("DistanceUnits = px",))
    yield turned("slope 2", "warned", "not applied", lines=("ElementToIntensityFunctionSlope = 2",))
    yield turned("slope 0.5", "warned", "not applied", values=[2 * v for v in g.values], lines=("ElementToIntensityFunctionSlope = 0.5",))
    yield turned("intercept", "warned", "not applied", lines=("ElementToIntensityFunctionOffset = -1024",))
    yield turned("four axes of one volume", dims=4, size=(*g.size, 1))
    yield turned("two volumes, the second", dims=4, size=(*g.size, 2), values=[0] * len(g.values) + g.values,
                 options=("--volume-index", "1"))
    yield turned("three channels", "refused", "components", lines=("ElementNumberOfChannels = 3",), values=g.values * 3)
    yield turned("negative spacing", "refused", "--spacing", names={"ElementSpacing": "Comment"}, lines=("ElementSpacing = -1 1 1",))
    yield turned("no spacing", "warned", "no spacing", names={"ElementSpacing": "Comment"})
    yield turned("a sheared matrix", "warned", "lean", names={"TransformMatrix": "Comment"},
                 lines=("TransformMatrix = 1 0 0 0.2 0.98 0 0 0 1",))


def volumes(grids):
    """All turned volumes: facts of each format on two turns of each lattice, and all turns of the axes."""
    for lattice, g in grids.items():
        first = None
        for turn in turns():
            at, where = g.turned(*turn), f"{lattice}, {turn_name(turn)}"
            original = Turned("NRRD", f"LPS; {where}", nrrd(at), original=first, isTurned=True)
            first = first or original
            if original is not first: yield original
            if turn in (((0, 1, 2), (False,) * 3), ((2, 0, 1), (True, False, False))):
                for file in (*niftis(at, original), *nrrds(at, original), *metas(at, original)):
                    file.fact += f"; {where}"
                    yield file
            for kind, fact, files in (("NIfTI", "sform", {"v.nii": nifti(at, q=0)}), ("NIfTI", "qform", {"v.nii": nifti(at, s=0)}),
                                      ("NRRD", "RAS", nrrd(at, space="RAS")), ("NRRD", "LAS", nrrd(at, space="LAS")),
                                      ("MetaImage", "matrix", meta(at))):
                yield Turned(kind, f"{fact}; {where}", files, original=original)
