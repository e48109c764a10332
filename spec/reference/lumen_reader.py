# SPDX-License-Identifier: Apache-2.0
"""A basic reader of lumen cases, written from spec/lumen.md and spec/schema alone. Without zstd and Draco, it refuses critical
chunks in them and ignores groups of others. Called as spec/conformance/README.md says: lumen_reader.py FILE < questions.json, or lumen_reader.py < lines"""
import base64, copy, functools, json, math, pathlib, re, struct, sys
from fractions import Fraction

INF, VERSION, CRITICAL = math.inf, [1, 2], "META NCEN NDIR NRAD NHEI NPAR NBRA BREC BLAB LINK".split()
GROUPS = ("NINL",), ("NARR",), ("MOVE",), ("POFF", "PPOS"), ("MKER", "MOFF", "MCEN", "MWID")
KNOWN, KERNELS, KINDS = CRITICAL + list(sum(GROUPS, ())), ["cauchy", "gaussian", "quartic", "soft-object"], ["vessel", "aneurysm"]
WORDS = {"LUMEN_node": ("LUMEN_node.origin", 3), "LUMEN_vessel": ("LUMEN_vessel.system", 5)}  # and the sizes of their tables
STOPS = "unknown no-valid-cylinder turned-back left-volume met-branch end-of-seeds step-limit".split()
ARRAYS = [word.split(":") for word in (  # part of the case, key, chunk, components, type
    "tree:centre:NCEN:3:f tree:direction:NDIR:3:f tree:radius:NRAD:1:f tree:height:NHEI:1:f tree:parent:NPAR:1:i tree:branch:NBRA:1:I "
    "tree:inlierRate:NINL:1:f tree:links:LINK:2:I points:offset:POFF:1:I points:position:PPOS:3:f models:offset:MOFF:1:I "
    "models:centre:MCEN:3:f models:width:MWID:1:f").split()]
CODES = {key: word.split(":")[0] for word in (  # of a value that is not among the legal ones of its key
    "NOT_LUMEN:format VERSION:version,minimumReader COORDINATE_SYSTEM:coordinateSystem UNITS:units "
    "RADIUS_RANGE:radius HEIGHT_RANGE:height INLIER_RATE_RANGE:inlierRate,meanInlierRate ENUM_VALUE:kind,stopReason,kernel,type "
    "JSON_CHUNK_DATA:data ISO_LEVEL:isoLevel WIDTH_RANGE:width VOXEL_SIZE:voxelSize SOURCE_SIZE:size SOURCE_SPACING:spacing "
    "SOURCE_SHA256:sha256 PARENT_SHA256:parentSha256 POINT_QUANTISATION:bits,step RANDOM_SEED:random-seed NODE_BRANCH:branch "
    "EXTENSION_NAME:extensionsUsed,extensionsRequired NODE_ARRAY_NAME:name NODE_ARRAY_COMPONENTS:components NODE_PARENT:parent "
    "MOTION_PERIOD:period MOTION_NODE:node MOTION_FACTOR:factor BRANCH_PARENT:parentNode BRANCH_RANGE:firstNode,nodeCount LINK_NODE:links").split() for key in word.split(":")[1].split(",")}
class Refused(Exception): pass
class Decimal(str): pass  # a number in JSON that is no integer, until its type is known
TYPES = {"object": (dict,), "array": (list,), "string": (str,), "boolean": (bool,), "integer": (int,), "number": (int, float, Decimal)}
CRC = [functools.reduce(lambda c, _: c >> 1 ^ (0x82F63B78 if c & 1 else 0), range(8), c) for c in range(256)]
def crc32c(data): return functools.reduce(lambda c, byte: c >> 8 ^ CRC[(c ^ byte) & 255], data, 0xFFFFFFFF) ^ 0xFFFFFFFF
def need(at, **rules):  # code=condition, in order
    for code, holds in rules.items():
        if not holds: raise Refused(code, at)

SURROGATES = re.compile(r"\\(?:u[dD][89abAB]..\\u[dD][c-fC-F]..|(u[dD][89a-fA-F]..)|.)", re.S)  # the group: half a pair
def parse_json(data, at=""):
    def depth(v): return 1 + max(map(depth, v.values() if type(v) is dict else v), default=0) if type(v) in (dict, list) else 0
    try:
        v = json.loads(data.decode(), parse_int=lambda s: int(s) if len(s) < 400 else Decimal(s), parse_float=Decimal,
                       object_pairs_hook=lambda items: need(at, JSON_DUPLICATE_KEY=len(dict(items)) == len(items)) or dict(items),
                       parse_constant=lambda name: need(at, JSON_SYNTAX=False))  # NaN and Infinity are not JSON
        half = next((m for m in SURROGATES.finditer(data.decode()) if m[1]), None)
        if half: need(at or len(data.decode()[:half.start()].encode()), JSON_SYNTAX=False)
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
        need(at, **{"CHUNK_TYPE" if "{4}$" in s.get("pattern", "") else code:
                    v in s.get("enum", [s.get("const", v)]) and re.search(s.get("pattern", ""), v)})
    elif kind != "boolean" and not at.startswith("/nodeArrays"):  # of those, the type is known later
        whole, low, high = type(v) is int and s.get("type") != "number", s.get("minimum", -INF), s.get("maximum", INF)
        if not whole: v = real(v, not at.startswith("/metadata") and key not in ("kernelParameter", "isoLevel", "time", "period"), at)
        need(at, NUMBER_RANGE=not whole or -2**63 <= v < (2**64 if key == "rawSize" else 2**63) and (v >= 0 or low < 0 or code[:3] in ("RAN", "POI")))
        need(at, **{"NUMBER_RANGE" if high == 65535 else code: low <= v <= high and v > s.get("exclusiveMinimum", -INF)})
    return v
def check_case(m, lacking=()):
    need("", JSON_TYPE=type(m) is dict)
    version, reader = ([int(x) for x in re.findall("[0-9]{1,3}", str(m.get(k, "1.0")))] for k in ("version", "minimumReader"))
    need("", VERSION=reader <= min(version, VERSION))
    others = m.get("otherChunks", []) if type(m.get("otherChunks", [])) is list else []
    left = [o for o in others if type(o) is dict and o.get("type") == "MOVE"]  # by a program that did not know it
    if len(left) == 1 and "motion" not in m and left[0].get("version") == 1 and left[0].get("encoding") == 0:
        others.remove(left[0])
        try: m["motion"] = read_motion("/otherChunks", base64.b64decode(left[0].get("data", "")))
        except (Refused, ValueError): need("/otherChunks", JSON_CHUNK_DATA=False)
    m = conform(m, {"$ref": "case.schema.json"}, "", version > VERSION)
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
    need("/metadata/extensionsRequired", EXTENSION_UNLISTED=set(needed) <= set(used), EXTENSION_REQUIRED=set(needed) <= set(WORDS))
    need("/metadata/nodeArrays", NODE_ARRAY_NAME=len(arrays := {a["name"]: a for a in described}) == len(described),
         EXTENSION_UNLISTED=all(name.split(".")[0] in used for name in arrays))
    need("/nodeArrays", JSON_KEY_UNKNOWN=set(values) <= set(arrays), JSON_KEY_MISSING=set(values) >= set(arrays) or "NARR" in lacking)
    for name, a in arrays.items():
        low, high, array = *((-2**31, 2**31 - 1) if a["type"] == "i32" else (0, 2**32 - 1)), values.get(name, [0] * n * a["components"])
        need(f"/nodeArrays/{name}", ARRAY_LENGTH=len(array) == n * a["components"],
             JSON_TYPE=a["type"] == "f32" or all(type(x) is int for x in array))
        need(f"/nodeArrays/{name}", NUMBER_RANGE=a["type"] == "f32" or all(low <= x <= high for x in array))
        words, of = WORDS.get(name.split(".")[0], ("", 0)), f"/metadata/nodeArrays/{described.index(a)}"
        words = words[1] if words[0] == name else 0  # values of its table; 0: any
        need(f"{of}/components", NODE_ARRAY_COMPONENTS=not words or a["components"] == 1)
        need(f"{of}/type", ENUM_VALUE=not words or a["type"] == "u32")
        for i, x in enumerate(array if words else ()): need(f"/nodeArrays/{name}/{i}", ENUM_VALUE=x < words)
        if a["type"] == "f32": array[:] = [real(x, True, f"/nodeArrays/{name}/{i}") for i, x in enumerate(array)]
    for part, items in (("points", "position"), ("models", "centre")):
        offset, count = (g := m.get(part, {"offset": [0] * (n + 1), items: ()}))["offset"], len(g[items])
        need(f"/{part}", KERNEL_PARAMETER=g.get("kernel") not in KERNELS[:2] or g["kernelParameter"] > 0,
             ARRAY_LENGTH=len(g.get("width", g[items])) == count and len(offset) == n + 1)
        for i in range(n): need(f"/{part}/offset/{i + 1}", OFFSET_START=offset[0] == 0, OFFSET_ORDER=offset[i] <= offset[i + 1])
        need(f"/{part}/offset", OFFSET_END=offset[n] == count)
    if "motion" in m: check_motion(m["motion"], n)
    return need("/otherChunks", JSON_CHUNK_DATA=all(
        o["type"] not in KNOWN and ("rawSize" in o) == (o["encoding"] > 0) and (
            o["encoding"] not in (1, 2) or o["rawSize"] <= 256 * len(base64.b64decode(o["data"]))) for o in m.get("otherChunks", ()))) or m

def check_motion(g, n):
    times, nodes = g["time"], g["node"]
    need("/motion/time", MOTION_TIME=times and all(a < b for a, b in zip(times, times[1:])), LIMIT=len(times) * len(nodes) <= 2 ** 26)
    need("/motion/period", MOTION_PERIOD=g.get("period", INF) > times[-1] - times[0])
    for i, node in enumerate(nodes): need(f"/motion/node/{i}", MOTION_NODE=(i == 0 or nodes[i - 1] < node) and node < n)
    for key in ("centre", "rotation", "factor"):
        need(f"/motion/{key}", ARRAY_LENGTH=len(g[key]) == len(times) and all(len(row) == len(nodes) for row in g[key]))
    for t, row in enumerate(g["rotation"]):
        for i, q in enumerate(row): need(f"/motion/rotation/{t}/{i}", MOTION_ROTATION=abs(math.hypot(*q) - 1) <= 0.001)
def read_motion(at, body):
    need(at, CHUNK_LENGTH=len(body) >= 16)
    count, moving, period = struct.unpack_from("<IId", body)
    need(at, LIMIT=count <= 4096 and count * moving <= 2 ** 26, MOTION_PERIOD=not period < 0)
    need(at, CHUNK_LENGTH=len(body) == 16 + 8 * count + 4 * moving + 32 * count * moving)
    poses = list(struct.iter_unpack("<8f", body[16 + 8 * count + 4 * moving:]))
    rows = [poses[t * moving:(t + 1) * moving] for t in range(count)]
    return {"time": [*struct.unpack_from(f"<{count}d", body, 16)], "node": [*struct.unpack_from(f"<{moving}I", body, 16 + 8 * count)],
            **({"period": period} if period else {}), "centre": [[list(p[:3]) for p in row] for row in rows],
            "rotation": [[list(p[3:7]) for p in row] for row in rows], "factor": [[p[7] for p in row] for row in rows]}

def read_binary(data):
    need(0, MAGIC=data[:10] == b"\x8cLUMEN\r\n\x1a\n"[:len(data)], TRUNCATED=len(data) >= 64)
    *v, size, length, count, table_crc, reserved, crc = struct.unpack("<4BHQII28sI", data[10:64])
    newer, end, chunks, others, lacking = v[:2] > VERSION, 64 + 64 * count, {}, [], set()
    need(0, HEADER_CHECKSUM=crc32c(data[:60]) == crc, VERSION=[1, 0] <= v[2:] <= min(v[:2], VERSION),
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
             CHUNK_EXPANSION=encoding not in (1, 2) or raw <= 256 * stored)
        if known: chunks.setdefault(name, []).append((offset, body))
        else: others.append({"type": name, "version": version, "independent": flags & 2 > 0, "encoding": encoding,
                             "data": base64.b64encode(body).decode(), **({"rawSize": raw} if encoding else {})})
        if known and encoding: lacking.update(*(g for g in GROUPS if name in g))
    need(end - 1, TRAILING_BYTES=-(-end // 64) * 64 >= length, TRUNCATED=-(-end // 64) * 64 <= length, CHUNK_PADDING=not any(data[end:]))
    need("file", CHUNK_MISSING=set(CRITICAL[:9]) <= set(chunks) and all(len(chunks.keys() & g) in (0, len(g)) for g in GROUPS[3:]))
    chunks = {name: found for name, found in chunks.items() if name not in lacking}
    m = dict(format="lumen", version="%d.%d" % (*v[:2],), minimumReader="%d.%d" % (*v[2:],), otherChunks=others, tree={"branches": []}, nodeArrays={})
    ((meta_at, meta), (labels_at, labels), (records_at, records)), end = (chunks[k][0] for k in ("META", "BLAB", "BREC")), 0
    m["metadata"] = conform(parse_json(meta, meta_at), load("metadata.schema.json"), "/metadata", newer)
    for part, key, name, width, kind in ARRAYS:
        for at, body in chunks.get(name, ()):
            need(at, CHUNK_LENGTH=len(body) % (4 * int(width)) == 0)
            m.setdefault(part, {})[key] = [row[0] if width == "1" else list(row) for row in struct.iter_unpack(f"<{width}{kind}", body)]
    for at, body in chunks.get("MKER", ()):
        need(at, CHUNK_LENGTH=len(body) == 24, ENUM_VALUE=body[:1] < b"\4", CHUNK_FIELD=not any(body[1:8]))
        m["models"] |= zip(("kernel", "kernelParameter", "isoLevel"), (KERNELS[body[0]], *struct.unpack("<dd", body[8:])))
    for at, body in chunks.get("MOVE", ()): m["motion"] = read_motion(at, body)
    need(records_at, CHUNK_LENGTH=len(records) % 24 == 0)
    for first, count, parent, start, size, kind, stop, rate in struct.iter_unpack("<IIiIHBBf", records):
        need(records_at, LABEL_OFFSET=start == end, CHUNK_LENGTH=end + size <= len(labels), ENUM_VALUE=kind < 2 and stop < 7)
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

# the fields, from "Semantics" and "The blended field" ----------------------------------------------------------------------

def sub(a, b): return [x - y for x, y in zip(a, b)]
def dot(a, b): return sum(x * y for x, y in zip(a, b))
def add_scaled(a, s, b): return [x + s * y for x, y in zip(a, b)]
def cross(a, b): return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]

def kernel(name, a, x):
    """phi and its derivative."""
    if name == "cauchy": return (1 + a * x) ** -2, -2 * a * (1 + a * x) ** -3
    if name == "gaussian": return math.exp(-a * x), -a * math.exp(-a * x)
    if x >= 1: return 0.0, 0.0
    if name == "quartic": return (1 - x) ** 2, -2 * (1 - x)
    return 1 - (4 * x ** 3 - 17 * x ** 2 + 22 * x) / 9, (-12 * x ** 2 + 34 * x - 22) / 9

def psi(t):
    """psi and its derivative, for t > -1."""
    s = min((1 + t) / 2, 1)
    return s ** 3 * (6 * s * s - 15 * s + 10), 15 * s * s * (1 - s) ** 2

# poses, from "Motion" ---------------------------------------------------------------------------------------------------------

def turned(q, v):
    twice = [2 * x for x in cross(q[:3], v)]
    return [a + q[3] * b + c for a, b, c in zip(v, twice, cross(q[:3], twice))]
def unit(q): return [x / math.hypot(*q) for x in q]
def slerp(a, b, u):
    a, b = unit(a), unit(b)
    if dot(a, b) < 0: b = [-x for x in b]
    theta = 2 * math.atan2(math.dist(a, b), math.hypot(*(x + y for x, y in zip(a, b))))
    return [(math.sin((1 - u) * theta) * x + math.sin(u * theta) * y) / math.sin(theta) for x, y in zip(a, b)] if theta else a
def instant(g, t):
    """Two of a motion's times, and the share of the way between them."""
    times, period = g["time"], g.get("period", 0)
    if period: t = times[0] + (t - times[0]) % period
    if t >= times[-1]: return len(times) - 1, 0, (t - times[-1]) / (times[0] + period - times[-1]) if period else 0
    later = next(i for i, x in enumerate(times) if x > t)
    return (later - 1, later, (t - times[later - 1]) / (times[later] - times[later - 1])) if later else (0, 0, 0)
def poses_at(g, t):
    """By moving node: centre, rotation and factor at a time."""
    i, k, u = instant(g, t)
    def mixed(a, b): return (1 - u) * a + u * b
    return {node: ([mixed(a, b) for a, b in zip(g["centre"][i][n], g["centre"][k][n])],
                   slerp(g["rotation"][i][n], g["rotation"][k][n], u), mixed(g["factor"][i][n], g["factor"][k][n]))
            for n, node in enumerate(g["node"])}

class Case:
    """The tree, with the neighbours of every node, and the models if there are any."""

    def __init__(self, m):
        self.centre, self.radius, self.models = m["tree"]["centre"], m["tree"]["radius"], m.get("models")
        self.count = len(self.radius)
        self.edges = [set() for _ in range(self.count)]
        for i, k in [*enumerate(m["tree"]["parent"]), *m["tree"].get("links", ())]:
            if k >= 0:
                self.edges[i].add(k)
                self.edges[k].add(i)
        self.motion, self.poses, self.rest = m.get("motion"), {}, self.centre
        self.longest = self.spacings()
        self.near = [set() for _ in range(self.count)]
        for i in range(self.count):
            for way, length in self.ways(i):
                if len(way) <= 3 or self.are_close(way[0], way[-1], length) and self.cells_meet(way):
                    self.near[way[0]].add(way[-1])
                    self.near[way[-1]].add(way[0])

    def spacings(self): return [max((self.distance(i, k) ** 2 for k in self.edges[i]), default=0) for i in range(self.count)]
    def at(self, time):
        """The posed case, whose neighbours are those at rest."""
        out = copy.copy(self)
        out.poses = poses_at(self.motion, time)
        out.centre = [out.poses[i][0] if i in out.poses else c for i, c in enumerate(self.centre)]
        out.radius = [out.poses[i][2] * r if i in out.poses else r for i, r in enumerate(self.radius)]
        out.longest = out.spacings()
        return out
    def distance(self, i, k): return math.dist(self.centre[i], self.centre[k])
    def power(self, i, p): return math.dist(p, self.centre[i]) ** 2 - self.radius[i] ** 2

    def ways(self, start):
        """The way from a node to each other that a breadth-first search finds, with its length."""
        queue, seen = [([start], 0.0)], {start}
        for way, length in queue:
            if len(way) > 2 and length > 8 * self.radius[start]: continue
            for other in sorted(self.edges[way[-1]] - seen):
                seen.add(other)
                queue.append((way + [other], length + self.distance(way[-1], other)))
        return queue[1:]

    def are_close(self, i, k, length):
        both, distance = self.radius[i] + self.radius[k], self.distance(i, k)
        return length <= 4 * both and (distance < both or length < 2 * distance)

    def cells_meet(self, way):
        """Whether the nodes between leave a part of the square on the radical plane of both ends."""
        i, k, ri, rk, a = way[0], way[-1], self.radius[way[0]], self.radius[way[-1]], sub(self.centre[way[-1]], self.centre[way[0]])
        d = math.hypot(*a)
        if d == 0: return ri == rk
        s = (1 + (ri * ri - rk * rk) / d ** 2) / 2
        q = max((1.5 * ri) ** 2 - (s * d) ** 2, (1.5 * rk) ** 2 - ((1 - s) * d) ** 2)
        if q <= 0: return False
        shortest = min(range(3), key=lambda axis: abs(a[axis]))
        u = cross(a, [float(axis == shortest) for axis in range(3)])
        u = [math.sqrt(q) / math.hypot(*u) * x for x in u]
        v = [x / d for x in cross(a, u)]
        middle = add_scaled(self.centre[i], s, a)
        square = [add_scaled(add_scaled(middle, x, u), y, v) for x, y in ((1, 1), (-1, 1), (-1, -1), (1, -1))]
        for m in way[1:-1]: square = self.cut(square, i, m, max(self.tau(i, m), self.tau(k, m)))
        return bool(square)

    def cut(self, polygon, i, m, slack):
        """The part of a polygon where p_m - p_i + slack >= 0."""
        left, kept = [self.power(m, x) - self.power(i, x) + slack for x in polygon], []
        for (x, f), (y, g) in zip(zip(polygon, left), zip(polygon[1:] + polygon[:1], left[1:] + left[:1])):
            if f >= 0: kept.append(x)
            if (f >= 0) != (g >= 0): kept.append(add_scaled(x, f / (f - g), sub(y, x)))
        return kept

    def tau(self, i, k):
        square, least = self.distance(i, k) ** 2, 0.001 * min(self.radius[i], self.radius[k]) ** 2
        return max(least, 0.6 * square if k in self.edges[i] else min(0.5 * square, 0.3 * (self.longest[i] + self.longest[k])))

    def follow(self, node, p):
        while (best := min(self.near[node], key=lambda k: (self.power(k, p), k), default=node)) != node:
            if self.power(best, p) >= self.power(node, p): break
            node = best
        return node

    def lender(self, node):
        """The nearest node along the tree that has blobs, or None."""
        offset, ring, seen = self.models["offset"], {node}, {node}
        while ring:
            for i in sorted(ring):
                if offset[i] < offset[i + 1]: return i
            ring = {k for i in ring for k in self.edges[i]} - seen
            seen |= ring

    def local(self, node, p):
        """Value and gradient of the local field."""
        g, node, value, gradient = self.models, self.lender(node), 0.0, [0.0] * 3
        centre, q, s = self.poses.get(node, ((0, 0, 0), (0, 0, 0, 1), 1))
        if node in self.poses: p = add_scaled(self.rest[node], 1 / s, turned([-q[0], -q[1], -q[2], q[3]], sub(p, centre)))
        for j in range(g["offset"][node], g["offset"][node + 1]) if node is not None else ():
            d, w = sub(p, g["centre"][j]), g["width"][j]
            phi, slope = kernel(g["kernel"], g["kernelParameter"], dot(d, d) / w ** 2)
            value, gradient = value + w * phi, add_scaled(gradient, 2 * slope / w, d)
        return value, [x / s for x in turned(q, gradient)]

    def weight(self, k, p):
        """The weight of a node, its gradient, and the neighbours that it does not beat by tau."""
        u, logarithmic, rivals = 1.0, [0.0] * 3, []
        for j in sorted(self.near[k]):
            tau = self.tau(k, j)
            t = (self.power(j, p) - self.power(k, p)) / tau
            if t >= 1: continue
            if t <= -1: return 0.0, [0.0] * 3, []
            value, slope = psi(t)
            u, logarithmic = u * value, add_scaled(logarithmic, 2 * slope / value / tau, sub(self.centre[k], self.centre[j]))
            rivals.append(j)
        return u, [u * x for x in logarithmic], rivals

    def blended(self, node, p):
        """Value and gradient of the blended field."""
        active, total, total_slope, value, slope = [node], 0.0, [0.0] * 3, 0.0, [0.0] * 3
        for k in active:
            u, du, rivals = self.weight(k, p)
            if u == 0: continue
            f, df = self.local(k, p)
            total, total_slope = total + u, add_scaled(total_slope, 1, du)
            value, slope = value + u * f, add_scaled(add_scaled(slope, u, df), f, du)
            active += [j for j in rivals if j not in active]
        if total == 0: return self.local(node, p)
        return value / total, [x / total for x in add_scaled(slope, -value / total, total_slope)]

    def shown(self, field): return {"value": field[0], "gradient": field[1], "inside": field[0] > self.models["isoLevel"]}

    def answer(self, question):
        p = question["point"]
        if "time" in question: self = self.at(question["time"])
        if "current" in question: node = self.follow(question["current"], p)
        else: node = min(range(self.count), key=lambda i: (self.power(i, p), i))
        out = {"node": node, "power": self.power(node, p)}
        return {**out, **self.shown(self.local(node, p)), "blended": self.shown(self.blended(node, p))} if self.models else out

def reply(file, questions):
    data, binary = pathlib.Path(file).read_bytes(), not file.endswith(".json")
    try:
        case = read_binary(data) if binary else check_case(parse_json(data))
        return {"accepted": True, "case": case, "answers": list(map(Case(case).answer, questions)) if questions else []}
    except Refused as e: code, at = e.args
    return {"accepted": False, "code": "CHUNK_LENGTH" if binary and code == "ARRAY_LENGTH" else code, "place": f"byte {at}" if type(at) is int else at}

if __name__ == "__main__":
    for call in map(json.loads, sys.stdin) if len(sys.argv) == 1 else [{"file": sys.argv[1], "questions": json.load(sys.stdin)}]:
        print(json.dumps(reply(**call)), flush=True)
