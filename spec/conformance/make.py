#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the files of the conformance set from its data: see README.md, "Adding a case".

make.py FOLDER           writes the set into FOLDER/valid and FOLDER/hostile
make.py --check FOLDER   writes nothing; exit status 1 if digests.txt does not state the digests of the set in FOLDER
make.py --renew FOLDER   writes the set, and its digests into digests.txt

Shares no code with any reader: it has its own writer, and answers.py computes the expected answers with exact fractions, to
be rounded once, at the end."""
import argparse, functools, hashlib, json, pathlib, re, struct, sys
from fractions import Fraction

from answers import Answers, Undecided
from encoding import CRITICAL, chunk, chunks_of, crc32c, exact, layout, parse

HERE = pathlib.Path(__file__).resolve().parent
GROUPS = {"tree/inlierRate": ["NINL"], "nodeArrays": ["NARR"], "motion": ["MOVE"], "points": ["POFF", "PPOS"],
          "models": ["MKER", "MOFF", "MCEN", "MWID"]}
HEADER = {"signature": (0, "10s"), "version": (10, "BB"), "minimumReader": (12, "BB"), "headerSize": (14, "H"),
          "length": (16, "Q"), "count": (24, "I"), "tableCrc": (28, "I"), "reserved": (32, "28s"), "headerCrc": (60, "I")}
ENTRY = {"type": (0, "4s"), "version": (4, "H"), "flags": (6, "B"), "encoding": (7, "B"), "offset": (8, "Q"),
         "stored": (16, "Q"), "raw": (24, "Q"), "crc": (32, "I"), "reserved": (36, "28s")}
FORMATS = {"u8": "<B", "u16": "<H", "u32": "<I", "u64": "<Q", "i32": "<i", "f32": "<f", "f64": "<d"}


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


@functools.cache
def texts():
    """The JSON text of every valid case, by name."""
    parts = re.split(r"^== (.+)\n", (HERE / "valid.txt").read_text(), flags=re.M)
    out = dict(zip(parts[1::2], parts[2::2]))
    for recipe in json.loads((HERE / "valid.json").read_text()):
        if "like" not in recipe: continue
        text = out[recipe["like"]]
        for old, new in recipe.get("text", ()):
            text = change_json(text, "text", old, new)
        out[recipe["name"]] = text
    return out


def made(recipe):
    """The file of a recipe."""
    text = texts()[recipe["from"]]
    if "json" in recipe:
        for change in recipe["json"]:
            text = change_json(text, *change)
        data = text.encode()
        for old, new in recipe.get("raw", ()):
            assert data.count(bytes.fromhex(old)) >= 1
            data = data.replace(bytes.fromhex(old), bytes.fromhex(new), 1)
        return data
    case = parse(text)
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
    """(name, contents) of every file of the set."""
    for recipe in json.loads((HERE / "valid.json").read_text()):
        stem, text = f"valid/{recipe['name']}", texts()[recipe["name"]]
        data = made({"from": recipe["name"], **recipe}) if recipe.get("binary", True) else None
        if data is not None:
            digest = hashlib.sha256(data).hexdigest()
            if recipe.get("frozen", digest) != digest:  # released: whatever is changed here, this file never is
                raise SystemExit(f"{stem}.lumen has changed: {digest}")
            yield f"{stem}.lumen", data
        yield f"{stem}.lumen.json", text.encode()
        yield f"{stem}.queries.json", dumped({
            "feature": recipe["feature"], "ignored": recipe.get("ignored", []), "lacking": encodings_of(data) if data else {},
            "queries": answered(recipe["name"], parse(text), recipe.get("questions", ()))}).encode()
    for recipe in json.loads((HERE / "hostile.json").read_text()):
        data = made(recipe)
        yield f"hostile/{recipe['name']}" + (".lumen.json" if "json" in recipe else ".lumen"), data
        yield f"hostile/{recipe['name']}.report.json", dumped(report_of(recipe, data)).encode()


def write(folder):
    for name, data in outputs():
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(data)


def digests(folder):
    """A line for each kind of file, with the SHA-256 of all names and contents."""
    kinds = {}
    for file in sorted(folder.glob("*/*")):
        kind = f"{file.parent.name}/*.{file.name.partition('.')[2]}"
        line = f"{hashlib.sha256(file.read_bytes()).hexdigest()}  {file.name}\n"
        kinds.setdefault(kind, hashlib.sha256()).update(line.encode())
    return "".join(f"{kinds[kind].hexdigest()}  {kind}\n" for kind in sorted(kinds))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--renew", action="store_true")
    parser.add_argument("folder", type=pathlib.Path)
    given, stated = parser.parse_args(), HERE / "digests.txt"
    folder = given.folder
    if not given.check: write(folder)
    if given.renew: stated.write_text(digests(folder))
    if given.check and digests(folder) != stated.read_text():
        sys.exit(f"{stated} does not state the digests of {folder}, which are\n{digests(folder)}"
                 "To see what has changed, compare with a set that was made before.")


if __name__ == "__main__":
    main()
