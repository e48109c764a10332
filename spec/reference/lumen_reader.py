# SPDX-License-Identifier: Apache-2.0
"""A basic reader of lumen cases, written from spec/lumen.md and spec/schema alone. Without zstd and Draco, it refuses critical
chunks in them and ignores groups of others. Called as spec/conformance/README.md says: lumen_reader.py FILE < questions.json"""
import base64, functools, json, math, pathlib, re, struct, sys
from fractions import Fraction

INF, CRITICAL = math.inf, "META NCEN NDIR NRAD NHEI NPAR NBRA BREC BLAB LINK".split()
GROUPS = ("NINL",), ("NARR",), ("POFF", "PPOS"), ("MKER", "MOFF", "MCEN", "MWID"), ("CKER", "COFF", "CCEN", "CWID")
KNOWN, KERNELS, KINDS = CRITICAL + list(sum(GROUPS, ())), ["cauchy", "gaussian", "quartic", "soft-object"], ["vessel", "aneurysm"]
STOPS = "unknown no-valid-cylinder turned-back left-volume met-branch end-of-seeds step-limit".split()
ARRAYS = [word.split(":") for word in (  # part of the case, key, chunk, components, type
    "tree:centre:NCEN:3:f tree:direction:NDIR:3:f tree:radius:NRAD:1:f tree:height:NHEI:1:f tree:parent:NPAR:1:i tree:branch:NBRA:1:I "
    "tree:inlierRate:NINL:1:f tree:links:LINK:2:I points:offset:POFF:1:I points:position:PPOS:3:f models:offset:MOFF:1:I "
    "models:centre:MCEN:3:f models:width:MWID:1:f compactModels:offset:COFF:1:I compactModels:centre:CCEN:3:f "
    "compactModels:width:CWID:1:f").split()]
CODES = {key: word.split(":")[0] for word in (  # of a value that is not among the legal ones of its key
    "NOT_LUMEN:format VERSION:version,minimumReader COORDINATE_SYSTEM:coordinateSystem UNITS:units "
    "RADIUS_RANGE:radius HEIGHT_RANGE:height INLIER_RATE_RANGE:inlierRate,meanInlierRate ENUM_VALUE:kind,stopReason,kernel,type "
    "JSON_CHUNK_DATA:data ISO_LEVEL:isoLevel WIDTH_RANGE:width VOXEL_SIZE:voxelSize SOURCE_SIZE:size SOURCE_SPACING:spacing "
    "SOURCE_SHA256:sha256 PARENT_SHA256:parentSha256 POINT_QUANTISATION:bits,step RANDOM_SEED:random-seed NODE_BRANCH:branch "
    "EXTENSION_NAME:extensionsUsed,extensionsRequired NODE_ARRAY_NAME:name NODE_ARRAY_COMPONENTS:components NODE_PARENT:parent "
    "BRANCH_PARENT:parentNode BRANCH_RANGE:firstNode,nodeCount LINK_NODE:links").split() for key in word.split(":")[1].split(",")}
class Refused(Exception): pass
class Decimal(str): pass  # a number in JSON that is no integer, until its type is known
TYPES = {"object": (dict,), "array": (list,), "string": (str,), "boolean": (bool,), "integer": (int,), "number": (int, float, Decimal)}
CRC = [functools.reduce(lambda c, _: c >> 1 ^ (0x82F63B78 if c & 1 else 0), range(8), c) for c in range(256)]
def crc32c(data): return functools.reduce(lambda c, byte: c >> 8 ^ CRC[(c ^ byte) & 255], data, 0xFFFFFFFF) ^ 0xFFFFFFFF
def need(at, **rules):  # code=condition, in order
    for code, holds in rules.items():
        if not holds: raise Refused(code, at)

def parse_json(data, at=""):
    def depth(v): return 1 + max(map(depth, v.values() if type(v) is dict else v), default=0) if type(v) in (dict, list) else 0
    try:
        v = json.loads(data.decode(), parse_int=lambda s: int(s) if len(s) < 400 else Decimal(s), parse_float=Decimal,
                       object_pairs_hook=lambda items: need(at, JSON_DUPLICATE_KEY=len(dict(items)) == len(items)) or dict(items),
                       parse_constant=lambda name: need(at, JSON_SYNTAX=False))  # NaN and Infinity are not JSON
        return need(at, JSON_DEPTH=depth(v) <= 64) or v
    except RecursionError: need(at, JSON_DEPTH=False)
    except ValueError as e: need(at or (len(e.doc[:e.pos].encode()) if hasattr(e, "pos") else e.start), JSON_SYNTAX=False)
def real(v, single, at):
    x = float(v) if type(v) is not int or abs(v) < 10 ** 300 else INF
    if single and x and type(v) is not float and abs(x) < INF:  # round to odd first, so that the second rounding is right
        if Fraction(v) != x and not struct.pack("<d", x)[0] & 1: x = math.nextafter(x, INF if Fraction(v) > x else -INF)
        x = struct.unpack("<f", struct.pack("<f", x))[0] if abs(x) < 3.4028235677973366e38 else INF
    return need(at, **{"NOT_FINITE" if type(v) is float else "NUMBER_RANGE": math.isfinite(x)}) or x
def text(v, s, at):
    need(at, TEXT_UTF8=not re.search("[\ud800-\udfff]", v), TEXT_CONTROL=not re.search("[\0-\x1f\x7f-\x9f]", v))
    need(at, **{"LABEL_EMPTY" if v == "" and at.endswith("/label") else "TEXT_LENGTH":
                s.get("minLength", 0) <= len(v) and len(v.encode()) <= s.get("maxLength", INF)})
@functools.lru_cache
def load(name): return resolved(json.loads((pathlib.Path(__file__).parent.parent / "schema" / name).read_text()))
def resolved(s): return {**(base := load(s["$ref"])), "properties": base.get("properties", {}) | s.get("properties", {})} if "$ref" in s else s

def conform(v, s, at, newer, key=""):  # v, of which the schema s must be true, with numbers converted and without comments
    s = resolved(s)
    kind, code, least, most = s.get("type", "string"), CODES.get(key, "NUMBER_RANGE"), s.get("minItems"), s.get("maxItems", INF)
    if "anyOf" in s: kind = next((o["type"] for o in s["anyOf"] if type(v) in TYPES[o["type"]]), kind)
    need(at, **{code if key == "random-seed" else "JSON_TYPE": type(v) in TYPES[kind]})
    if kind == "object":
        known, rest = s["properties"] if "properties" in s else {}, s["additionalProperties"]
        need(at, LIMIT=len(v) <= s.get("maxProperties", INF), JSON_KEY_MISSING=set(s.get("required", ())) <= set(v))
        for k in v:
            need(f"{at}/{k}", JSON_KEY_UNKNOWN=k in known or rest or newer or k.startswith("x-"))
            if rest: text(k, s.get("propertyNames", {}), at)
        return {k: conform(x, known.get(k, rest), f"{at}/{k}", newer, k) for k, x in v.items() if k in known or rest}
    if kind == "array":
        need(at, LIMIT=most == least or len(v) <= most, ARRAY_LENGTH=most != least or len(v) == most,
             EXTENSION_DUPLICATE="uniqueItems" not in s or len(set(map(str, v))) == len(v))
        return [conform(x, s["items"], f"{at}/{i}", newer, key) for i, x in enumerate(v)]
    if kind == "string":
        text(v, s, at)
        need(at, **{"COMPACT_KERNEL" if v in KERNELS else "CHUNK_TYPE" if "{4}$" in s.get("pattern", "") else code:
                    v in s.get("enum", [s.get("const", v)]) and re.search(s.get("pattern", ""), v)})
    elif kind != "boolean" and not at.startswith("/nodeArrays"):  # of those, the type is known later
        whole, low, high = type(v) is int and s.get("type") != "number", s.get("minimum", -INF), s.get("maximum", INF)
        if not whole: v = real(v, not at.startswith("/metadata") and key not in ("kernelParameter", "isoLevel"), at)
        need(at, NUMBER_RANGE=not whole or -2**63 <= v < 2**63 and (v >= 0 or low < 0 or code[:3] in ("RAN", "POI")))
        need(at, **{"NUMBER_RANGE" if high == 65535 else code: low <= v <= high and v > s.get("exclusiveMinimum", -INF)})
    return v
def check_case(m, lacking=()):
    need("", JSON_TYPE=type(m) is dict)
    version, reader = ([int(x) for x in re.findall("[0-9]{1,3}", str(m.get(k, "1.0")))] for k in ("version", "minimumReader"))
    need("", VERSION=reader <= min(version, [1, 0]))
    m = conform(m, {"$ref": "case.schema.json"}, "", version > [1, 0])
    t, values, end = m["tree"], m.get("nodeArrays", {}), 0
    n, labels = len(t["centre"]), [b["label"] for b in t["branches"]]
    need("/tree", TREE_EMPTY=n, ARRAY_LENGTH=all(key in ("branches", "links") or len(t[key]) == n for key in t))
    for i, d in enumerate(t["direction"]): need(f"/tree/direction/{i}", DIRECTION_LENGTH=abs(math.hypot(*d) - 1) <= 0.001)
    for i, p in enumerate(t["parent"]): need(f"/tree/parent/{i}", NODE_PARENT=p < i)
    for i, b in enumerate(t["branches"]):
        at, first, end = f"/tree/branches/{i}", end, end + b["nodeCount"]
        need(at, BRANCH_RANGE=b["firstNode"] == first < end <= n, LABEL_DUPLICATE=b["label"] not in labels[:i])
        need(f"{at}/parentNode", BRANCH_PARENT=b["parentNode"] == t["parent"][first])
        for k in range(first, end):
            need(f"/tree/branch/{k}", NODE_BRANCH=t["branch"][k] == i)
            need(f"/tree/parent/{k}", NODE_CHAIN=k == first or t["parent"][k] == k - 1)
    need("/tree/branches", BRANCH_RANGE=end == n)
    for i, (a, b) in enumerate(t.get("links", ())):
        need(f"/tree/links/{i}", LINK_NODE=max(a, b) < n, LINK_ORDER=a < b and (i == 0 or t["links"][i - 1] < [a, b]),
             LINK_PARENT=b >= n or t["parent"][b] != a)
    axes, used, needed, described = (m["metadata"].get(k, ()) for k in ("source", "extensionsUsed", "extensionsRequired", "nodeArrays"))
    for i in range(9 if axes else 0): need("/metadata/source/direction", SOURCE_DIRECTION=math.isclose(  # axes times axes
        sum(axes["direction"][k + i // 3] * axes["direction"][k + i % 3] for k in (0, 3, 6)), i % 4 == 0, rel_tol=0, abs_tol=1e-4))
    need("/metadata/extensionsRequired", EXTENSION_UNLISTED=set(needed) <= set(used), EXTENSION_REQUIRED=not needed)
    need("/metadata/nodeArrays", NODE_ARRAY_NAME=len(arrays := {a["name"]: a for a in described}) == len(described),
         EXTENSION_UNLISTED=all(name.split(".")[0] in used for name in arrays))
    need("/nodeArrays", JSON_KEY_UNKNOWN=set(values) <= set(arrays), JSON_KEY_MISSING=set(values) >= set(arrays) or "NARR" in lacking)
    for name, a in arrays.items():
        low, high, array = *((-2**31, 2**31 - 1) if a["type"] == "i32" else (0, 2**32 - 1)), values.get(name, [0] * n * a["components"])
        need(f"/nodeArrays/{name}", ARRAY_LENGTH=len(array) == n * a["components"],
             NUMBER_RANGE=all(a["type"] == "f32" or type(x) is int and low <= x <= high for x in array))
        if a["type"] == "f32": array[:] = [real(x, True, f"/nodeArrays/{name}/{i}") for i, x in enumerate(array)]
    for part, items in (("points", "position"), ("models", "centre"), ("compactModels", "centre")):
        offset, count = (g := m.get(part, {"offset": [0] * (n + 1), items: ()}))["offset"], len(g[items])
        need(f"/{part}", KERNEL_PARAMETER=g.get("kernel") not in KERNELS[:2] or g["kernelParameter"] > 0,
             ARRAY_LENGTH=len(g.get("width", g[items])) == count and len(offset) == n + 1)
        for i in range(n): need(f"/{part}/offset/{i + 1}", OFFSET_START=offset[0] == 0, OFFSET_ORDER=offset[i] <= offset[i + 1])
        need(f"/{part}/offset", OFFSET_END=offset[n] == count, COMPACT_ALONE="models" in m or "compactModels" not in m)
    return need("/otherChunks", JSON_CHUNK_DATA=all(
        o["type"] not in KNOWN and ("rawSize" in o) == (o["encoding"] > 0) for o in m.get("otherChunks", ()))) or m

def read_binary(data):
    need(0, MAGIC=data[:10] == b"\x8cLUMEN\r\n\x1a\n"[:len(data)], TRUNCATED=len(data) >= 64)
    *v, size, length, count, table_crc, reserved, crc = struct.unpack("<4BHQII28sI", data[10:64])
    newer, end, chunks, others, lacking = v[:2] > [1, 0], 64 + 64 * count, {}, [], set()
    need(0, HEADER_CHECKSUM=crc32c(data[:60]) == crc, VERSION=[1, 0] <= v[2:] <= min(v[:2], [1, 0]),
         HEADER_FIELD=size == 64 and (newer or not any(reserved)), TRUNCATED=length <= len(data), TRAILING_BYTES=length >= len(data),
         CHUNK_COUNT=count <= 4096 and end <= length, TABLE_CHECKSUM=crc32c(data[64:end]) == table_crc)
    for at in range(64, end, 64):
        name, version, flags, encoding, offset, stored, raw, crc, reserved = struct.unpack("<4sHBBQQQI28s", data[at:at + 64])
        need(at, CHUNK_TYPE=re.fullmatch(b"[A-Za-z0-9]{4}", name), CHUNK_FIELD=newer or flags < 4 and not any(reserved),
             CHUNK_OFFSET=offset == -(-end // 64) * 64, CHUNK_SIZE=offset + stored <= length and (encoding or raw == stored))
        need(offset - 1, CHUNK_PADDING=not any(data[end:offset]))
        name, critical, body, end = name.decode(), flags & 1, data[offset:offset + stored], offset + stored
        need(at, CHUNK_CHECKSUM=crc32c(body) == crc, CHUNK_UNKNOWN=(known := name in KNOWN) or not critical)
        need(at, CHUNK_FIELD=not known or critical == (name in CRITICAL), CHUNK_VERSION=not known or version == 1,
             CHUNK_DUPLICATE=name == "NARR" or name not in chunks, CHUNK_ENCODING=not known or encoding < 3 - critical - (name != "PPOS"),
             CHUNK_EXPANSION=not known or not encoding or raw <= 256 * stored)
        if known: chunks.setdefault(name, []).append((offset, body))
        else: others.append({"type": name, "version": version, "independent": flags & 2 > 0, "encoding": encoding,
                             "data": base64.b64encode(body).decode(), **({"rawSize": raw} if encoding else {})})
        if known and encoding: lacking.update(*(g for g in GROUPS if name in g), GROUPS[4] if name in GROUPS[3] else ())
    need(end - 1, TRAILING_BYTES=-(-end // 64) * 64 >= length, TRUNCATED=-(-end // 64) * 64 <= length, CHUNK_PADDING=not any(data[end:]))
    need("file", CHUNK_MISSING=set(CRITICAL[:9]) <= set(chunks) and all(len(chunks.keys() & g) in (0, len(g)) for g in GROUPS[2:]))
    chunks = {name: found for name, found in chunks.items() if name not in lacking}
    m = dict(format="lumen", version="%d.%d" % (*v[:2],), minimumReader="1.0", otherChunks=others, tree={"branches": []}, nodeArrays={})
    ((meta_at, meta), (labels_at, labels), (records_at, records)), end = (chunks[k][0] for k in ("META", "BLAB", "BREC")), 0
    m["metadata"] = conform(parse_json(meta, meta_at), load("metadata.schema.json"), "/metadata", newer)
    for part, key, name, width, kind in ARRAYS:
        for at, body in chunks.get(name, ()):
            need(at, CHUNK_LENGTH=len(body) % (4 * int(width)) == 0)
            m.setdefault(part, {})[key] = [row[0] if width == "1" else list(row) for row in struct.iter_unpack(f"<{width}{kind}", body)]
    for part, name in (("models", "MKER"), ("compactModels", "CKER")):
        for at, body in chunks.get(name, ()):
            need(at, CHUNK_LENGTH=len(body) == 24, ENUM_VALUE=body[:1] < b"\4", CHUNK_FIELD=not any(body[1:8]))
            m[part] |= zip(("kernel", "kernelParameter", "isoLevel"), (KERNELS[body[0]], *struct.unpack("<dd", body[8:])))
    need(records_at, CHUNK_LENGTH=len(records) % 24 == 0)
    for first, count, parent, start, size, kind, stop, rate in struct.iter_unpack("<IIiIHBBf", records):
        need(records_at, CHUNK_LENGTH=start == end and end + size <= len(labels), ENUM_VALUE=kind < 2 and stop < 7)
        label, end = labels[end:end + size].decode(errors="surrogateescape"), end + size
        m["tree"]["branches"].append(dict(label=label, kind=KINDS[kind], parentNode=parent, firstNode=first, nodeCount=count,
                                          stopReason=STOPS[stop], **({"meanInlierRate": rate} if rate != -1 else {})))
    arrays, stored = m["metadata"].get("nodeArrays", ()), chunks.get("NARR", ())
    need(labels_at, CHUNK_LENGTH=end == len(labels), CHUNK_DUPLICATE=len(arrays) >= len(stored),
         CHUNK_MISSING=len(arrays) <= len(stored) or "NARR" in lacking)
    for a, (at, body) in zip(arrays, stored):
        need(at, CHUNK_LENGTH=len(body) % 4 == 0)
        m["nodeArrays"][a["name"]] = [x for x, in struct.iter_unpack({"f32": "<f", "i32": "<i", "u32": "<I"}[a["type"]], body)]
    return check_case(m, lacking)

def field(g, node, p):  # value and gradient of a node's model
    value, gradient, a = 0.0, [0.0, 0.0, 0.0], g["kernelParameter"]
    for c, w in list(zip(g["centre"], g["width"]))[g["offset"][node]:g["offset"][node + 1]]:
        x = math.dist(p, c) ** 2 / w ** 2
        if g["kernel"] == "cauchy": phi, slope = (1 + a * x) ** -2, -2 * a * (1 + a * x) ** -3
        elif g["kernel"] == "gaussian": phi, slope = math.exp(-a * x), -a * math.exp(-a * x)
        elif x >= 1: phi = slope = 0
        elif g["kernel"] == "quartic": phi, slope = (1 - x) ** 2, -2 * (1 - x)
        else: phi, slope = 1 - (4 * x ** 3 - 17 * x ** 2 + 22 * x) / 9, (-12 * x ** 2 + 34 * x - 22) / 9
        value, gradient = value + w * phi, [d + 2 * slope * (u - v) / w for d, u, v in zip(gradient, p, c)]
    return {"value": value, "gradient": gradient, "inside": value > g["isoLevel"]}
def answer(m, question):
    t, p = m["tree"], question["point"]
    def power(i): return sum((u - v) ** 2 for u, v in zip(p, t["centre"][i])) - t["radius"][i] ** 2, i
    def near(i): return [j for j, q in enumerate(t["parent"]) if q == i or t["parent"][i] == j or sorted((i, j)) in t.get("links", ())]
    node = question["current"] if "current" in question else min(map(power, range(len(t["radius"]))))[1]
    while "current" in question and (best := min(map(power, near(node)), default=(INF, 0)))[0] < power(node)[0]: node = best[1]
    return {"node": node, "power": power(node)[0], **(field(m["models"], node, p) if "models" in m else {}),
            **({"compact": field(m["compactModels"], node, p)} if "compactModels" in m else {})}

if __name__ == "__main__":
    data, binary = pathlib.Path(sys.argv[1]).read_bytes(), not sys.argv[1].endswith(".json")
    try:
        case = read_binary(data) if binary else check_case(parse_json(data))
        print(json.dumps({"accepted": True, "case": case, "answers": [answer(case, q) for q in json.load(sys.stdin)]}))
    except Refused as e:
        code, at = ("CHUNK_LENGTH" if binary and e.args[0] == "ARRAY_LENGTH" else e.args[0]), e.args[1]
        print(json.dumps({"accepted": False, "code": code, "place": f"byte {at}" if type(at) is int else at}))
