# SPDX-License-Identifier: Apache-2.0
"""Centerlines as SWC, TubeTK's scenes, VTK's lines and Slicer's curves, each stated fact turned one at a time."""
import base64, json, math, struct, zlib

from turned import Turned, samples

LINES = samples()


def scaled(lines, k=1.0, signs=(1, 1, 1), shift=(0, 0, 0), radius=None):
    return [[(*(s * k * (x + d) for s, x, d in zip(signs, p[:3], shift)), p[3] * (k if radius is None else radius)) for p in line]
            for line in lines]


RAS = (-1, -1, 1)


# SWC -------------------------------------------------------------------------------------------

def rows(lines):
    """Points as rows (id, type, x, y, z, radius, parent); a vessel's first point is the last one of the first vessel."""
    made, end = [], -1
    for n, line in enumerate(lines):
        parent = end
        for p in (line if n == 0 else line[1:]):
            made.append([len(made) + 1, 2, *p, parent])
            parent = len(made)
        if n == 0: end = parent
    return made


def swc(lines=LINES, head="", change=lambda made: made, join=" ", eol="\n"):
    text = head + "".join(join.join(f"{v:.15g}" for v in row) + "\n" for row in change(rows(lines)))
    return text.replace("\n", eol).encode()


def swcs(original):
    def turned(fact, answer="same", words="", options=(), **how):
        return Turned("SWC", fact, {"c.swc": swc(**how)}, answer, words, options, original)

    def renumber(made, new):
        return [[new(r[0]), *r[1:6], new(r[6]) if r[6] > 0 else -1] for r in made]
    yield turned("comments alone", head="# a tree\n#\n")
    for unit, k in (("mm", 1), ("cm", 0.1), ("m", 1e-3), ("um", 1e3), ("micrometers", 1e3), ("microns", 1e3), ("nm", 1e6)):
        for said in (f"# units: {unit}\n", f"# all positions and radii in {unit}\n", f"# id type x y z radius parent; x, y, z in {unit}\n"):
            yield turned(said.strip(), lines=scaled(LINES, k), head=said)
        yield turned(f"--unit {unit}" if unit in ("mm", "cm", "m", "um", "nm") else f"# unit={unit}", lines=scaled(LINES, k),
                     **({"options": ("--unit", unit)} if unit in ("mm", "cm", "m", "um", "nm") else {"head": f"# unit={unit}\n"}))
    yield turned("NeuroMorpho's name", lines=scaled(LINES, 1e3), head="# from NeuroMorpho.org\n")
    yield turned("SCALE", lines=scaled(LINES, 0.5), head="# SCALE 2 2 2\n")
    yield turned("SCALE of 1", head="# SCALE 1.0 1.0 1.0\n")
    yield turned("a SCALE that is none", "same", "not applied", head="# SCALE -1 1 1\n")
    yield turned("SPACE=RAS", lines=scaled(LINES, signs=RAS), head="# SPACE=RAS\n")
    yield turned("SPACE=LPS", head="# SPACE=LPS\n")
    yield turned("--frame ras", lines=scaled(LINES, signs=RAS), options=("--frame", "ras"))
    yield turned("ids from 0", change=lambda m: [[r[0] - 1, *r[1:6], r[6] - 1 if r[6] > 0 else -1] for r in m])
    yield turned("ids with gaps", change=lambda m: renumber(m, lambda i: 10 * i))
    yield turned("ids backwards", change=lambda m: renumber(m, lambda i: 1000 - i))
    yield turned("children before parents", change=lambda m: m[::-1])
    yield turned("tabs", join="\t")
    yield turned("commas", "refused", "column|expected", join=",")
    yield turned("CR LF", eol="\r\n")
    yield turned("CR", eol="\r")
    yield turned("a byte order mark", head="\ufeff# x\n")
    yield turned("columns beyond the seventh", change=lambda m: [[*r, 7, 8] for r in m])
    yield turned("numbers with exponents", change=lambda m: [[*r[:2], *(float(f"{x:.12e}") for x in r[2:6]), r[6]] for r in m])
    yield turned("another type", change=lambda m: [[r[0], 3, *r[2:]] for r in m])
    yield turned("blanks before", change=lambda m: m, head="\n\n   \n")


# TubeTK ----------------------------------------------------------------------------------------

def tre(lines=LINES, spacing=(1, 1, 1), offset=None, matrix=None, columns="x y z r", binary="", scene=True, parents=True, group=None,
        first=None, unit_of_radius=1.0, rotation="TransformMatrix", place="Offset", kind="MET_FLOAT"):
    """`group`: matrix and offset of a group that holds the tubes. `binary`: byte order of struct, or text."""
    out = b"ObjectType = Scene\nNDims = 3\nNObjects = %d\n" % len(lines) if scene else b""
    put = lambda values: " ".join(repr(float(v)) for v in values)
    if group: out += f"ObjectType = Group\nNDims = 3\nID = 9\nTransformMatrix = {put(group[0])}\nOffset = {put(group[1])}\nElementSpacing = 1 1 1\nEndGroup = \n".encode()
    for n, line in enumerate(lines):
        parent = (0 if n and parents else 9 if group else -1)
        head = f"ObjectType = Tube\nNDims = 3\nID = {n}\nParentID = {parent}\n"
        if first and not n: head += f"TransformMatrix = {put(first[0])}\nOffset = {put(first[1])}\n"
        if n and parents: head += f"ParentPoint = {len(lines[0]) - 1}\nRoot = False\n"
        if matrix: head += f"{rotation} = {put(matrix)}\n"
        if offset: head += f"{place} = {put(offset)}\n"
        head += f"ElementSpacing = {put(spacing)}\n"
        if binary: head += f"BinaryData = True\nBinaryDataByteOrderMSB = {binary == '>'}\nElementType = {kind}\n"
        head += f"PointDim = {columns}\nNPoints = {len(line)}\nPoints = \n"
        named = [dict(zip("xyzr", (*p[:3], p[3] * unit_of_radius))) for p in line]
        values = [[at.get(c, 0.25) for c in columns.split()] for at in named]
        out += head.encode()
        if binary: out += b"".join(struct.pack(f"{binary}{len(v)}{'d' if kind == 'MET_DOUBLE' else 'f'}", *v) for v in values) + b"\n"
        else: out += "".join(put(v) + "\n" for v in values).encode()
    return out


def inverse_of_turn(lines):
    """Places before a quarter turn about z that takes x to y and y to -x, then a shift."""
    return [[(p[1] - 6, -(p[0] - 5), p[2] - 7, p[3]) for p in line] for line in lines]


TURN, SHIFT = (0, -1, 0, 1, 0, 0, 0, 0, 1), (5, 6, 7)


def tres(original):
    def turned(fact, answer="same", words="", options=(), **how):
        return Turned("TubeTK", fact, {"c.tre": tre(**how)}, answer, words, options, original)
    yield turned("plain")
    yield turned("no scene", scene=False)
    yield turned("no parents", parents=False)
    yield turned("ElementSpacing", lines=scaled(LINES, 2), spacing=(0.5, 0.5, 0.5))
    for name in ("Offset", "Position"): yield turned(name, lines=scaled(LINES, shift=(-5, -6, -7)), offset=SHIFT, place=name, parents=False)
    for name in ("TransformMatrix", "Rotation", "Orientation"):
        yield turned(name, lines=inverse_of_turn(LINES), matrix=TURN, offset=SHIFT, rotation=name, parents=False)
    yield turned("a matrix that scales", lines=scaled(LINES, 0.5), matrix=(2, 0, 0, 0, 2, 0, 0, 0, 2), parents=False)
    yield turned("spacing and a matrix that undoes it", lines=LINES, spacing=(2, 2, 2), matrix=(0.5, 0, 0, 0, 0.5, 0, 0, 0, 0.5), parents=False)
    yield turned("tubes within a tube that is moved", lines=inverse_of_turn(LINES), first=(TURN, SHIFT))
    yield turned("a group that is moved", lines=inverse_of_turn(LINES), group=(TURN, SHIFT), parents=False)
    yield turned("a group that scales", lines=scaled(LINES, 0.5), group=((2, 0, 0, 0, 2, 0, 0, 0, 2), (0, 0, 0)), parents=False)
    for columns in ("r x y z", "z y x r", "x y z r rn mn bn mk v1x v1y v1z", "tx x ty y z r"): yield turned(f"columns {columns}", columns=columns)
    for order in "<>":
        for kind in ("MET_FLOAT", "MET_DOUBLE"): yield turned(f"binary {kind} {order}", binary=order, kind=kind)


# VTK's lines -----------------------------------------------------------------------------------

def line_data(lines=LINES, shared=True):
    """Points, radii and the cells of points."""
    points, radii, cells = [], [], []
    for n, line in enumerate(lines):
        cell = []
        for i, p in enumerate(line):
            if shared and n and i == 0: cell.append(len(lines[0]) - 1); continue
            cell.append(len(points))
            points.append(p[:3])
            radii.append(p[3])
        cells.append(cell)
    return points, radii, cells


def two_points(cells):
    return [[a, b] for cell in cells for a, b in zip(cell, cell[1:])]


def to_tips(cells):
    """Each line from the root to a tip."""
    return [cells[0] + cell[1:] for cell in cells[1:]]


def array(name, kind, values, components=1, form="ascii", endian="<", header="I", pack=False, appended=None):
    code = {"Float32": "f", "Float64": "d", "Int64": "q", "Int32": "i", "UInt8": "B"}[kind]
    tag = f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" format="{form}"'
    if form == "ascii": return tag + ">" + " ".join(repr(float(v)) if code in "fd" else str(v) for v in values) + "</DataArray>"
    raw = struct.pack(f"{endian}{len(values)}{code}", *values)
    if pack:
        body = zlib.compress(raw)
        sizes, raw = struct.pack(f"{endian}4{header}", 1, len(raw), len(raw), len(body)), body
        coded = base64.b64encode(sizes) + base64.b64encode(body)
        whole = sizes + body
    else:
        whole = struct.pack(endian + header, len(raw)) + raw
        coded = base64.b64encode(whole)
    if form == "binary": return tag + ">" + coded.decode() + "</DataArray>"
    offset = sum(map(len, appended))
    appended.append(coded if appended.base64 else whole)
    return tag + f' offset="{offset}"/>'


class Appended(list):
    base64 = False


def field(texts, element="Array"):
    made = "".join(f'<{element} type="String" Name="{name}" NumberOfTuples="1" format="ascii">' +
                   " ".join(str(ord(c)) for c in text + "\0") + f"</{element}>" for name, text in texts.items())
    return f"<FieldData>{made}</FieldData>" if texts else ""


def vtp(points, cells, data=(), texts=None, kind="Lines", floats="Float32", form="ascii", endian="<", header="I", pack=False,
        base=False, element="Array", cell_data=()):
    """PolyData in XML. `data`: (name, values) of points."""
    appended = Appended()
    appended.base64 = base
    how = dict(form=form, endian=endian, header=header, pack=pack, appended=appended)
    ends = [sum(len(c) for c in cells[:n + 1]) for n in range(len(cells))]
    body = "<Points>" + array("Points", floats, [x for p in points for x in p], 3, **how) + "</Points><PointData>"
    body += "".join(array(n, floats, v, **how) for n, v in data) + "</PointData><CellData>"
    body += "".join(array(n, "Int32", v, **how) for n, v in cell_data) + "</CellData>"
    body += f"<{kind}>" + array("connectivity", "Int64", [i for c in cells for i in c], **how) + array("offsets", "Int64", ends, **how) + f"</{kind}>"
    packer = ' compressor="vtkZLibDataCompressor"' if pack else ""
    head = (f'<?xml version="1.0"?><VTKFile type="PolyData" version="1.0" byte_order="{"Little" if endian == "<" else "Big"}Endian" '
            f'header_type="UInt{32 if header == "I" else 64}"{packer}><PolyData>{field(texts or {}, element)}'
            f'<Piece NumberOfPoints="{len(points)}" NumberOf{kind}="{len(cells)}">{body}</Piece></PolyData>')
    coding = "base64" if base else "raw"
    tail = f'<AppendedData encoding="{coding}">_'.encode() + b"".join(appended) + b"</AppendedData>" if appended else b""
    return head.encode() + tail + b"</VTKFile>"


def legacy(points, cells, data=(), title="lines", texts=None, kind="LINES", binary=False, version="3.0", code="float", metadata=False):
    form = {"float": "f", "double": "d"}[code]
    def numbers(values, c):
        if binary: return struct.pack(f">{len(values)}{c}", *values) + b"\n"
        return (" ".join(repr(float(v)) if c in "fd" else str(v) for v in values) + "\n").encode()
    out = f"# vtk DataFile Version {version}\n{title}\n{'BINARY' if binary else 'ASCII'}\nDATASET POLYDATA\n".encode()
    if texts:
        out += f"FIELD FieldData {len(texts)}\n".encode()
        for name, text in texts.items():
            out += f"{name} 1 1 string\n".encode() + (bytes([0xC0 | len(text)]) if binary else b"") + text.encode() + b"\n"
    out += f"POINTS {len(points)} {code}\n".encode() + numbers([x for p in points for x in p], form)
    if metadata: out += b"METADATA\nINFORMATION 0\n\n"
    if version.startswith("5"):
        ends = [sum(len(c) for c in cells[:n]) for n in range(len(cells) + 1)]
        out += f"{kind} {len(ends)} {ends[-1]}\nOFFSETS vtktypeint64\n".encode() + numbers(ends, "q")
        out += b"CONNECTIVITY vtktypeint64\n" + numbers([i for c in cells for i in c], "q")
    else:
        flat = [x for c in cells for x in (len(c), *c)]
        out += f"{kind} {len(cells)} {len(flat)}\n".encode() + numbers(flat, "i")
    if data: out += f"POINT_DATA {len(points)}\n".encode()
    for n, (name, values) in enumerate(data):
        if n % 2 == 0: out += f"SCALARS {name} {code} 1\nLOOKUP_TABLE default\n".encode() + numbers(values, form)
        else: out += f"FIELD FieldData 1\n{name} 1 {len(values)} {code}\n".encode() + numbers(values, form)
    return out


def vtks(original):
    misr = "MaximumInscribedSphereRadius"
    for file, write in (("c.vtp", vtp), ("c.vtk", legacy)):
        xml = write is vtp

        def turned(fact, answer="same", words="", options=(), lines=LINES, cells=lambda c: c, radius=misr, shared=True, change=lambda r: r, **how):
            points, radii, made = line_data(lines, shared)
            data = [(radius, change(radii))] if radius else []
            return Turned("VTP lines" if xml else "VTK lines", fact, {file: write(points, cells(made), data, **how)}, answer, words, options, original)
        yield turned("polylines")
        for name in ("Radius", "radius"): yield turned(f"array {name}", radius=name)
        for name in ("Radii", "radii", "Radius [mm]", "MISR"):
            if xml or " " not in name: yield turned(f"array {name}", "refused", "Radius", radius=name)
        yield turned("array Diameter", "refused", "Radius", radius="Diameter", change=lambda r: [2 * x for x in r])
        yield turned("no radii", "refused", "Radius", radius=None)
        yield turned("cells of two points", cells=two_points)
        yield turned("lines to each tip", cells=to_tips)
        yield turned("lines to each tip, without shared points", cells=lambda c: c, shared=False)
        yield turned("lines in another order", cells=lambda c: c[::-1])
        yield turned("cells of two points, turned", cells=lambda c: [x[::-1] for x in two_points(c)])
        yield turned("SPACE RAS in field data", lines=scaled(LINES, signs=RAS), texts={"SPACE": "RAS"})
        yield turned("SPACE LPS in field data", texts={"SPACE": "LPS"})
        yield turned("--frame ras", lines=scaled(LINES, signs=RAS), options=("--frame", "ras"))
        for unit, k in (("mm", 1), ("cm", 0.1), ("m", 1e-3), ("um", 1e3)):
            yield turned(f"Unit {unit} in field data", lines=scaled(LINES, k), texts={"Unit": unit})
            yield turned(f"--unit {unit}", lines=scaled(LINES, k), options=("--unit", unit))
        for name in ("Units", "units", "unit", "LengthUnit"):
            yield turned(f"{name} cm in field data", lines=scaled(LINES, 0.1), texts={name: "cm"})
        yield turned("an unknown unit", "same", "not known as a length", texts={"Unit": "furlong"})
        yield turned("unknown axes", "same", "LPS and RAS", texts={"SPACE": "LAS"})
        yield turned("unit by its size", "same", "", lines=scaled(LINES, 1e-3))
        if xml:
            for element in ("Array", "DataArray"): yield turned(f"SPACE as <{element}>", lines=scaled(LINES, signs=RAS), texts={"SPACE": "RAS"}, element=element)
            for floats in ("Float32", "Float64"):
                for endian in "<>":
                    for header in "IQ":
                        for pack in (False, True):
                            yield turned(f"base64 {floats} {endian} {header} {'packed' if pack else ''}", floats=floats, form="binary", endian=endian, header=header, pack=pack)
                for base in (False, True):
                    for pack in (False, True): yield turned(f"appended {floats} {base} {pack}", floats=floats, form="appended", base=base, pack=pack)
            continue
        yield turned("title SPACE=RAS", lines=scaled(LINES, signs=RAS), title="3D Slicer output. SPACE=RAS")
        for version in ("3.0", "4.2", "5.1"):
            for binary in (False, True):
                for code in ("float", "double"): yield turned(f"version {version} {code} {'binary' if binary else 'text'}", version=version, binary=binary, code=code, metadata=version == "5.1")
                yield turned(f"field data, version {version} {binary}", version=version, binary=binary, lines=scaled(LINES, 0.1, RAS), texts={"SPACE": "RAS", "Unit": "cm"})


# Slicer's curves -------------------------------------------------------------------------------

def curves(lines=LINES, system="LPS", unit="mm", radius_unit="mm", without=(), measure="Radius", status="defined", files=False, more=None):
    made = []
    for n, line in enumerate(lines):
        curve = {"type": "Curve", "name": f"c{n}", "coordinateSystem": system, "coordinateUnits": unit,
                 "controlPoints": [{"id": str(i), "position": list(p[:3]), "positionStatus": status, **(more or {})} for i, p in enumerate(line)],
                 "measurements": [{"name": measure, "enabled": True, "units": radius_unit, "controlPointValues": [p[3] for p in line]}]}
        made.append({k: v for k, v in curve.items() if k not in without})
    return json.dumps({"markups": made}).encode()


def slicer(original):
    def turned(fact, answer="same", words="", options=(), **how):
        return Turned("Slicer curves", fact, {"c.mrk.json": curves(**how)}, answer, words, options, original)
    ras = scaled(LINES, signs=RAS)
    for system in ("LPS", "1", 1): yield turned(f"coordinateSystem {system!r}", system=system)
    for system in ("RAS", "0", 0): yield turned(f"coordinateSystem {system!r}", lines=ras, system=system)
    yield turned("no coordinateSystem", without=("coordinateSystem",))
    yield turned("an unknown coordinateSystem", "refused", "LPS", system="SAR")
    for unit, k in (("mm", 1), ("cm", 0.1), ("m", 1e-3), ("um", 1e3)):
        yield turned(f"coordinateUnits {unit}", lines=scaled(LINES, k), unit=unit, radius_unit=unit)
        yield turned(f"coordinateUnits {unit}, radii in mm", lines=scaled(LINES, k, radius=1), unit=unit)
        yield turned(f"coordinateUnits {unit} as a code", lines=scaled(LINES, k), unit=[unit, "UCUM", "length"], radius_unit=unit)
        yield turned(f"radii in {unit}", lines=scaled(LINES, 1, radius=k), radius_unit=unit)
    yield turned("RAS and --frame ras", lines=ras, system="RAS", options=("--frame", "ras"))
    yield turned("RAS, but --frame lps", system="RAS", options=("--frame", "lps"))
    yield turned("m and --unit m", lines=scaled(LINES, 1e-3), unit="m", radius_unit="m", options=("--unit", "m"))
    yield turned("m, but --unit cm", lines=scaled(LINES, 0.1), unit="m", radius_unit="m", options=("--unit", "cm"))
    yield turned("no coordinateUnits", without=("coordinateUnits",))
    yield turned("an unknown unit", "refused", "mm", unit="px")
    yield turned("measurement radius", measure="radius")
    yield turned("radii without a unit", radius_unit="")
    yield turned("orientations", more={"orientation": [-1.0, -0.0, -0.0, -0.0, -1.0, -0.0, 0.0, 0.0, 1.0]})


def far(_):
    """Places 10 km away, which the answer states less that: doubles and text hold them, floats of a file do not."""
    lines = scaled(LINES, shift=(1e7 + 30, -2e7 - 30, 0))
    original = Turned("SWC", "moved by 30 mm", {"c.swc": swc(scaled(LINES, shift=(30, -30, 0)))})
    points, radii, cells = line_data(lines)
    for format, files in (("SWC", {"c.swc": swc(lines)}), ("TubeTK", {"c.tre": tre(lines)}), ("Slicer curves", {"c.mrk.json": curves(lines)}),
                          ("VTP lines", {"c.vtp": vtp(points, cells, [("Radius", radii)], floats="Float64")}),
                          ("VTK lines", {"c.vtk": legacy(points, cells, [("Radius", radii)], code="double")})):
        yield Turned(format, "10 km away", files, "same", "far from 0", (), original)


def all_lines():
    original = Turned("SWC", "mm, LPS", {"c.swc": swc()})
    for made in (swcs, tres, vtks, slicer, far): yield from made(original)
