# SPDX-License-Identifier: Apache-2.0
"""The two encodings of a case, for make.py and run.py: its JSON with every number as its decimal, and a canonical binary file."""
import base64, json, struct
from fractions import Fraction

KINDS = ["vessel", "aneurysm"]
STOPS = ["unknown", "no-valid-cylinder", "turned-back", "left-volume", "met-branch", "end-of-seeds", "step-limit"]
KERNELS = ["cauchy", "gaussian", "quartic", "soft-object"]
CRITICAL = ["META", "NCEN", "NDIR", "NRAD", "NHEI", "NPAR", "NBRA", "BREC", "BLAB", "LINK"]


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
