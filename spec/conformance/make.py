#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the files of the conformance set from its data: see README.md, "Adding a case".

make.py           writes what is missing or out of date
make.py --check   writes nothing; exit status 1 if there is such a file

Shares no code with any reader: it has its own writer, and answers.py computes the expected answers with exact fractions, to
be rounded once, at the end."""
import base64, hashlib, json, pathlib, struct, sys
from fractions import Fraction

from answers import Answers, Undecided

HERE = pathlib.Path(__file__).resolve().parent
KINDS = ["vessel", "aneurysm"]
STOPS = ["unknown", "no-valid-cylinder", "turned-back", "left-volume", "met-branch", "end-of-seeds", "step-limit"]
KERNELS = ["cauchy", "gaussian", "quartic", "soft-object"]
CRITICAL = ["META", "NCEN", "NDIR", "NRAD", "NHEI", "NPAR", "NBRA", "BREC", "BLAB", "LINK"]
GROUPS = {"tree/inlierRate": ["NINL"], "nodeArrays": ["NARR"], "motion": ["MOVE"], "points": ["POFF", "PPOS"],
          "models": ["MKER", "MOFF", "MCEN", "MWID"]}
HEADER = {"signature": (0, "10s"), "version": (10, "BB"), "minimumReader": (12, "BB"), "headerSize": (14, "H"),
          "length": (16, "Q"), "count": (24, "I"), "tableCrc": (28, "I"), "reserved": (32, "28s"), "headerCrc": (60, "I")}
ENTRY = {"type": (0, "4s"), "version": (4, "H"), "flags": (6, "B"), "encoding": (7, "B"), "offset": (8, "Q"),
         "stored": (16, "Q"), "raw": (24, "Q"), "crc": (32, "I"), "reserved": (36, "28s")}
FORMATS = {"u8": "<B", "u16": "<H", "u32": "<I", "u64": "<Q", "i32": "<i", "f32": "<f", "f64": "<d"}


class Number(str):
    """A number of a JSON text, kept as its decimal."""


def parse(text):
    return json.loads(text, parse_int=Number, parse_float=Number)


def crc32c(data):
    crc = 0xFFFFFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = (crc >> 1) ^ (0x82F63B78 & -(crc & 1))
    return crc ^ 0xFFFFFFFF


def f32_bits(number):
    """The bits of the f32 nearest to a decimal, by bisection over all of them: no rounding takes place on the way."""
    sign, value = number.startswith("-"), abs(Fraction(number))
    low, high = 0, 0x7F7FFFFF
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if f32_value(middle) <= value else (low, middle)
    below, above = value - f32_value(low), f32_value(high) - value
    bits = low if below < above or (below == above and low % 2 == 0) else high
    return bits | (sign << 31 if bits else 0)


def f32_value(bits):
    return Fraction(struct.unpack("<f", struct.pack("<I", bits))[0])


def f32(numbers):
    return struct.pack(f"<{len(numbers)}I", *map(f32_bits, numbers))


def exact(number):
    return Fraction(struct.unpack("<f", struct.pack("<I", f32_bits(number)))[0])


def flat(rows):
    return [x for row in rows for x in row]


def integers(code, values):
    return struct.pack(f"<{len(values)}{code}", *map(int, values))


# the binary encoding ---------------------------------------------------------------------------------------------------


def canonical_metadata(m):
    """META in the order of the property tables, reals with a point or an exponent."""
    def real(x): return repr(float(x) + 0.0)  # negative zero is written as zero
    def text(x): return json.dumps(x, ensure_ascii=False)
    def parameter(x):
        if isinstance(x, Number):
            return real(x) if set(x) & set(".eE") else str(int(x))
        return text(x)
    def reals(xs): return "[" + ",".join(map(real, xs)) + "]"
    def obj(pairs): return "{" + ",".join(f"{text(k)}:{v}" for k, v in pairs if v is not None) + "}"
    def listed(xs): return "[" + ",".join(xs) + "]"
    def texts(key): return listed(map(text, m[key])) if m.get(key) else None
    source = m.get("source") and obj([
        ("size", listed(map(str, m["source"]["size"]))), *((k, reals(m["source"][k])) for k in ("spacing", "origin", "direction")),
        ("sha256", text(m["source"]["sha256"]))])
    quantisation = m.get("pointQuantisation") and obj([
        ("bits", str(m["pointQuantisation"]["bits"])), ("step", real(m["pointQuantisation"]["step"]))])
    arrays = m.get("nodeArrays") and listed(obj([
        ("name", text(a["name"])), ("type", text(a["type"])), ("components", str(a["components"])),
        ("unit", text(a["unit"]) if a.get("unit") else None)]) for a in m["nodeArrays"])
    steps = listed(obj([("name", text(s["name"])), ("tool", text(s["tool"])), ("parameters", obj(
        (k, parameter(s["parameters"][k])) for k in sorted(s["parameters"], key=str.encode)))]) for s in m["steps"])
    return obj([("coordinateSystem", text(m["coordinateSystem"])), ("units", text(m["units"])),
                ("voxelSize", real(m["voxelSize"]) if "voxelSize" in m else None), ("source", source),
                ("parentSha256", text(m["parentSha256"]) if "parentSha256" in m else None),
                ("pointQuantisation", quantisation), ("note", text(m["note"]) if "note" in m else None),
                ("extensionsUsed", texts("extensionsUsed")), ("extensionsRequired", texts("extensionsRequired")),
                ("nodeArrays", arrays), ("steps", steps)]).encode()


def chunk(kind, body, **fields):
    return {"type": kind, "body": body, "version": 1, "flags": int(kind in CRITICAL), "encoding": 0, "raw": None, **fields}


def model_chunks(m):
    kernel = struct.pack("<B7xdd", KERNELS.index(m["kernel"]), float(m["kernelParameter"]), float(m["isoLevel"]))
    return [chunk("MKER", kernel), chunk("MOFF", integers("I", m["offset"])),
            chunk("MCEN", f32(flat(m["centre"]))), chunk("MWID", f32(m["width"]))]


def motion_chunk(m):
    times, nodes = m["time"], m["node"]
    body = struct.pack("<IId", len(times), len(nodes), float(m.get("period", 0)))
    body += struct.pack(f"<{len(times)}d", *map(float, times)) + integers("I", nodes)
    for row in zip(m["centre"], m["rotation"], m["factor"]):
        body += b"".join(f32([*centre, *rotation, factor]) for centre, rotation, factor in zip(*row))
    return chunk("MOVE", body)


def chunks_of(case):
    """The chunks of a canonical file of a case in its JSON encoding."""
    t = case["tree"]
    labels = [b["label"].encode() for b in t["branches"]]
    records, at = b"", 0
    for b, label in zip(t["branches"], labels):
        rate = f32([b["meanInlierRate"]]) if "meanInlierRate" in b else struct.pack("<f", -1)
        records += struct.pack("<IIiIHBB", int(b["firstNode"]), int(b["nodeCount"]), int(b["parentNode"]), at, len(label),
                               KINDS.index(b["kind"]), STOPS.index(b["stopReason"])) + rate
        at += len(label)
    out = [chunk("META", canonical_metadata(case["metadata"])), chunk("NCEN", f32(flat(t["centre"]))),
           chunk("NDIR", f32(flat(t["direction"]))), chunk("NRAD", f32(t["radius"])), chunk("NHEI", f32(t["height"])),
           chunk("NPAR", integers("i", t["parent"])), chunk("NBRA", integers("I", t["branch"]))]
    if "inlierRate" in t:
        out.append(chunk("NINL", f32(t["inlierRate"])))
    out += [chunk("BREC", records), chunk("BLAB", b"".join(labels))]
    if t.get("links"):
        out.append(chunk("LINK", integers("I", flat(t["links"]))))
    if "points" in case:
        out += [chunk("POFF", integers("I", case["points"]["offset"])), chunk("PPOS", f32(flat(case["points"]["position"])))]
    if "models" in case:
        out += model_chunks(case["models"])
    for a in case["metadata"].get("nodeArrays", ()):
        values = case["nodeArrays"][a["name"]]
        out.append(chunk("NARR", f32(values) if a["type"] == "f32" else integers(a["type"][0].replace("u", "I"), values)))
    if "motion" in case:
        out.append(motion_chunk(case["motion"]))
    for o in case.get("otherChunks", ()):
        out.append(chunk(o["type"], base64.b64decode(o["data"]), version=int(o["version"]), flags=2 if o["independent"] else 0,
                         encoding=int(o["encoding"]), raw=int(o["rawSize"]) if "rawSize" in o else None))
    return out


def layout(chunks, header):
    table, data, at = b"", b"", 64 + 64 * len(chunks)
    for c in chunks:
        raw = len(c["body"]) if c["raw"] is None else c["raw"]
        table += struct.pack("<4sHBBQQQI", c["type"].encode(), c["version"], c["flags"], c["encoding"], at, len(c["body"]), raw,
                             crc32c(c["body"])) + bytes(28)
        data += c["body"] + bytes(-len(c["body"]) % 64)
        at += len(c["body"]) + -len(c["body"]) % 64
    head = b"\x8cLUMEN\r\n\x1a\n" + bytes(header) + struct.pack("<HQII", 64, at, len(chunks), crc32c(table)) + bytes(28)
    return bytearray(head + struct.pack("<I", crc32c(head)) + table + data)


# recipes: changes of a file, as data -----------------------------------------------------------------------------------


def entry_of(file, kind):
    """Offset of the table entry of a chunk; NAME#2 is the second of that name."""
    name, _, ordinal = kind.partition("#")
    count = min(struct.unpack_from("<I", file, 24)[0], (len(file) - 64) // 64)
    found = [at for at in range(64, 64 + 64 * count, 64) if file[at:at + 4] == name.encode()]
    return found[int(ordinal or 1) - 1]


def place_of(file, place):
    """The byte of a place: 12, "header.length", "NRAD.offset", "NRAD", "NRAD+4", or "end"."""
    if place == "end":
        return len(file)
    if isinstance(place, int):
        return place
    name, dot, field = place.partition(".")
    if name == "header":
        return HEADER[field][0]
    if dot:
        return entry_of(file, name) + ENTRY[field][0]
    name, _, index = place.partition("+")
    return struct.unpack_from("<Q", file, entry_of(file, name) + 8)[0] + int(index or 0)


def regions_of(file, place):
    """Where else a reader may see what is wrong at a place: in the header, or in a chunk, its padding and its table entry."""
    if isinstance(place, int) or place == "end" or place.startswith("header."):
        return [[0, 63]] if not isinstance(place, int) or place < 64 else [[place, place]]
    entry = entry_of(file, place.partition(".")[0].partition("+")[0])
    offset, stored = struct.unpack_from("<QQ", file, entry + 8)
    return [[entry, entry + 63]] + [[offset, max(offset, (offset + stored + 63) // 64 * 64 - 1)]] * (offset + stored <= len(file))


def resign(file, part="all"):
    """Makes all checksums right, or the header's, as a hostile writer would."""
    if part == "header":
        struct.pack_into("<I", file, 60, crc32c(file[:60]))
        return
    count = struct.unpack_from("<I", file, 24)[0]
    for at in range(64, min(64 + 64 * count, len(file) - 63), 64):
        offset, stored = struct.unpack_from("<QQ", file, at + 8)
        if offset + stored <= len(file):
            struct.pack_into("<I", file, at + 32, crc32c(file[offset:offset + stored]))
    if 64 + 64 * count <= len(file):
        struct.pack_into("<I", file, 28, crc32c(file[64:64 + 64 * count]))
    struct.pack_into("<I", file, 60, crc32c(file[:60]))


def number(kind, value):
    return struct.pack(FORMATS[kind], float(value) if kind[0] == "f" else value)


def change_chunks(chunks, op, *a):
    def find(name):
        name, _, ordinal = name.partition("#")
        return [i for i, c in enumerate(chunks) if c["type"] == name][int(ordinal or 1) - 1]
    if op == "add":
        spec = dict(a[0])
        body = spec.pop("text").encode() if "text" in spec else bytes.fromhex(spec.pop("hex", ""))
        chunks.append(chunk(spec.pop("type"), body, **spec))
        return
    i = find(a[0])
    c = chunks[i]
    if op == "drop": del chunks[i]
    elif op == "copy": chunks.insert(i + 1, dict(c))
    elif op == "last": chunks.append(chunks.pop(i))
    elif op == "hex": c["body"] = bytes.fromhex(a[1])
    elif op == "extend": c["body"] += bytes.fromhex(a[1])
    elif op == "shorten": c["body"] = c["body"][:-a[1]]
    elif op == "text": c["body"] = a[1].encode()
    elif op == "replace":
        assert c["body"].count(a[1].encode()) == 1, (a, c["body"])
        c["body"] = c["body"].replace(a[1].encode(), a[2].encode())
    elif op == "field": c[a[1]] = a[2]
    elif op == "stored": c.update(encoding=a[1], raw=len(c["body"]), body=bytes.fromhex(a[2]))
    else: raise SystemExit(f"unknown change {op}")


def change_bytes(file, op, *a):
    if op == "cut": del file[place_of(file, a[0]):]
    elif op == "append": file += bytes.fromhex(a[0])
    elif op == "resign": resign(file, *a)
    elif op == "hex":
        at = place_of(file, a[0])
        file[at:at + len(a[1]) // 2] = bytes.fromhex(a[1])
    elif op in FORMATS:
        at, data = place_of(file, a[0]), number(op, a[1])
        file[at:at + len(data)] = data
    else: raise SystemExit(f"unknown change {op}")


def change_json(text, op, *a):
    if op == "text":
        assert text.count(a[0]) == 1, (a, text.count(a[0]))
        return text.replace(a[0], a[1])
    case = json.loads(text)
    *path, last = a[0].split("/")[1:]
    inner = case
    for key in path:
        inner = inner[int(key) if isinstance(inner, list) else key]
    last = int(last) if isinstance(inner, list) else last
    if op == "set": inner[last] = a[1]
    elif op == "remove": del inner[last]
    elif op == "insert": inner.insert(last, a[1])
    else: raise SystemExit(f"unknown change {op}")
    return json.dumps(case, ensure_ascii=False)


def made(recipe):
    """The file of a recipe: [contents, changed contents]."""
    base = HERE / "valid" / recipe["from"]
    if "json" in recipe:
        text = base.with_suffix(".lumen.json").read_text()
        for change in recipe["json"]:
            text = change_json(text, *change)
        data = text.encode()
        for old, new in recipe.get("raw", ()):
            assert data.count(bytes.fromhex(old)) >= 1
            data = data.replace(bytes.fromhex(old), bytes.fromhex(new), 1)
        return data
    case = parse(base.with_suffix(".lumen.json").read_text())
    chunks = chunks_of(case)
    for change in recipe.get("chunks", ()):
        change_chunks(chunks, *change)
    file = layout(chunks, recipe.get("versions", [1, 2 if "motion" in case else 1, 1, 0]))
    for change in recipe.get("bytes", ()):
        change_bytes(file, *change)
    return bytes(file)


def report_of(recipe, data):
    """The expected report; `within` is where a reader may see the fault."""
    out = {"fault": recipe["fault"], "code": recipe["code"] if isinstance(recipe["code"], list) else [recipe["code"]]}
    if "at" in recipe:
        out["place"] = f"byte {place_of(data, recipe['at'])}"
        out["within"] = recipe.get("within", regions_of(data, recipe["at"]))
    if "pointer" in recipe:
        out["pointer"] = recipe["pointer"]
    return {**out, **{k: recipe[k] for k in ("unread", "basic") if k in recipe}}


# expected answers ------------------------------------------------------------------------------------------------------


def vectors(rows):
    return [[exact(x) for x in row] for row in rows]


def motion_of(m):
    return m and {
        "time": [Fraction(float(x)) for x in m["time"]], "period": Fraction(float(m.get("period", 0))),
        "node": list(map(int, m["node"])), "centre": list(map(vectors, m["centre"])), "rotation": list(map(vectors, m["rotation"])),
        "factor": [list(map(exact, row)) for row in m["factor"]]}


def answers_of(case):
    """Answers to the questions of a case in its JSON encoding."""
    t, m = case["tree"], case.get("models")
    tree = {"centre": vectors(t["centre"]), "radius": list(map(exact, t["radius"])), "parent": list(map(int, t["parent"])),
            "links": [(int(a), int(b)) for a, b in t.get("links", ())]}
    models = m and {
        "kernel": m["kernel"], "kernelParameter": Fraction(float(m["kernelParameter"])), "isoLevel": Fraction(float(m["isoLevel"])),
        "offset": list(map(int, m["offset"])), "centre": vectors(m["centre"]), "width": list(map(exact, m["width"]))}
    return Answers(tree, models, motion_of(case.get("motion")))


def answered(name, case, questions):
    if not questions: return []
    try:
        answers = answers_of(case)
        return [{**q, **answers.answer([Fraction(float(x)) for x in q["point"]], q.get("current"), q.get("time"))} for q in questions]
    except Undecided as error:
        raise SystemExit(f"{name}: rounding would decide {error}")


def encodings_of(file):
    """Permitted reactions of a basic reader, by encoding that it lacks: refuse, or ignore these keys."""
    out = {}
    for at in range(64, 64 + 64 * struct.unpack_from("<I", file, 24)[0], 64):
        kind, encoding = file[at:at + 4].decode(), ["", "zstd", "draco"][file[at + 7]] if file[at + 7] < 3 else ""
        keys = [key for key, group in GROUPS.items() if kind in group]
        if encoding and (kind in CRITICAL or keys):
            out.setdefault(encoding, []).extend(k for k in keys or ["refuse"] if k not in out.get(encoding, ()))
    return out


def dumped(value):
    return json.dumps(value, indent=1, ensure_ascii=False).replace("\n", "\n") + "\n"


def outputs():
    """(path, contents) of every file that is made."""
    for recipe in json.loads((HERE / "valid.json").read_text()):
        stem = HERE / "valid" / recipe["name"]
        data = made({"from": recipe["name"], **recipe}) if recipe.get("binary", True) else None
        if data is not None:
            if recipe.get("frozen"):  # released: whatever is changed here, this file never is
                data = stem.with_suffix(".lumen").read_bytes() if stem.with_suffix(".lumen").exists() else data
                if hashlib.sha256(data).hexdigest() != recipe["frozen"]:
                    raise SystemExit(f"{stem.name}.lumen has changed: {hashlib.sha256(data).hexdigest()}")
            yield stem.with_suffix(".lumen"), data
        case = parse(stem.with_suffix(".lumen.json").read_text())
        yield stem.with_suffix(".queries.json"), dumped({
            "feature": recipe["feature"], "ignored": recipe.get("ignored", []), "lacking": encodings_of(data) if data else {},
            "queries": answered(recipe["name"], case, recipe.get("questions", ()))}).encode()
    for recipe in json.loads((HERE / "hostile.json").read_text()):
        data = made(recipe)
        yield HERE / "hostile" / (recipe["name"] + (".lumen.json" if "json" in recipe else ".lumen")), data
        yield HERE / "hostile" / (recipe["name"] + ".report.json"), dumped(report_of(recipe, data)).encode()


def main():
    stale = [(path, data) for path, data in outputs() if not path.exists() or path.read_bytes() != data]
    for path, data in stale:
        print(path.relative_to(HERE))
        if "--check" not in sys.argv: path.write_bytes(data)
    sys.exit(1 if stale and "--check" in sys.argv else 0)


if __name__ == "__main__":
    main()
