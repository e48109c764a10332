# SPDX-License-Identifier: Apache-2.0
"""A reader of BagIt bags by RFC 8493, and of what spec/library.md says of libraries, that shares nothing with lumen."""
import hashlib, json, pathlib, re

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCHEMAS = ROOT / "spec/schema"


def sha256(path):
    with open(path, "rb") as file:
        digest = hashlib.sha256()
        while block := file.read(1 << 20): digest.update(block)
        return digest.hexdigest()


def manifest(path):
    """Digests by path; None for a line that is none, or a path that is there twice (RFC 8493, 2.1.3)."""
    found = {}
    for line in path.read_text("utf-8").splitlines():
        match = re.fullmatch(r"([0-9a-fA-F]{64})[ \t]+\*?(.+)", line)
        if not match or match[2] in found or match[2].startswith(("/", "~")) or ".." in match[2].split("/"): return None
        found[match[2].replace("%0A", "\n").replace("%0D", "\r").replace("%25", "%")] = match[1].lower()
    return found


def bag_faults(bag):
    """Faults that make the folder no complete and valid bag (RFC 8493, section 3)."""
    if (bag / "bagit.txt").read_bytes() != b"BagIt-Version: 1.0\nTag-File-Character-Encoding: UTF-8\n": yield "bagit.txt"
    payload = {p.relative_to(bag).as_posix(): p for p in (bag / "data").rglob("*") if p.is_file() or p.is_symlink()}
    for name in ("manifest-sha256.txt", "tagmanifest-sha256.txt"):
        listed = manifest(bag / name)
        if listed is None:
            yield f"{name}: a line is none"
            continue
        if name.startswith("manifest"):
            yield from (f"{name}: {path} is not listed" for path in payload.keys() - listed.keys())
            yield from (f"{name}: {path} is no payload" for path in listed if not path.startswith("data/"))
        elif "manifest-sha256.txt" not in listed or any(p.startswith("tagmanifest") for p in listed):
            yield f"{name}: it must list the manifest, and no tag manifest"
        for path, digest in listed.items():
            if not (bag / path).is_file(): yield f"{name}: {path} is missing"
            elif sha256(bag / path) != digest: yield f"{name}: {path} has another digest"
    info = dict(line.split(": ", 1) for line in (bag / "bag-info.txt").read_text("utf-8").splitlines())
    if info["Payload-Oxum"] != f"{sum(p.stat().st_size for p in payload.values())}.{len(payload)}": yield "Payload-Oxum"
    if not re.fullmatch(r"\d{4}-\d\d-\d\d", info["Bagging-Date"]): yield "Bagging-Date"


def crate_faults(file):
    """Faults of an RO-Crate metadata file and its root, by the specification 1.2."""
    document = json.loads(file.read_text("utf-8"))
    if document["@context"] != "https://w3id.org/ro/crate/1.2/context": yield f"{file}: @context"
    by_id = {}
    for entity in document["@graph"]:
        if entity["@id"] in by_id: yield f"{file}: {entity['@id']} is there twice"
        by_id[entity["@id"]] = entity
        for key, value in entity.items():  # flattened: a value is plain, or a reference, or a list of them
            for one in value if isinstance(value, list) else [value]:
                if isinstance(one, dict) and list(one) != ["@id"]: yield f"{file}: {entity['@id']}: {key} is nested"
    descriptor = by_id["ro-crate-metadata.json"]
    if descriptor["@type"] != "CreativeWork" or descriptor["about"] != {"@id": "./"}: yield f"{file}: descriptor"
    if descriptor["conformsTo"] != {"@id": "https://w3id.org/ro/crate/1.2"}: yield f"{file}: conformsTo"
    root = by_id["./"]
    for key in ("name", "description", "datePublished", "license"):
        if not root.get(key): yield f"{file}: the root has no {key}"
    if root["@type"] != "Dataset": yield f"{file}: the root is no Dataset"
    if "name" not in by_id[root["license"]["@id"]]: yield f"{file}: the licence is not described"
    for part in root["hasPart"]:
        place = file.parent / part["@id"]
        entity = by_id[part["@id"]]
        if part["@id"].endswith("/"):
            if not (place / "ro-crate-metadata.json").is_file(): yield f"{file}: {part['@id']} is no crate"
            if entity["conformsTo"] != {"@id": "https://w3id.org/ro/crate"}: yield f"{file}: {part['@id']}: conformsTo"
        elif not place.is_file(): yield f"{file}: {part['@id']} is missing"
        elif "contentSize" in entity and int(entity["contentSize"]) != place.stat().st_size: yield f"{file}: {part['@id']}: size"


def schema_faults(value, name):
    try:
        import jsonschema
    except ImportError:
        return []
    store = {p.name: json.loads(p.read_text()) for p in SCHEMAS.glob("*.schema.json")}
    import warnings
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        resolver = jsonschema.RefResolver("", store[name], store=store)
        errors = jsonschema.Draft202012Validator(store[name], resolver=resolver).iter_errors(value)
        return [f"{name}: {e.json_path}: {e.message}" for e in errors]


def library_faults(library):
    """All that is wrong with a library, by the specification alone."""
    if not (library / "library.json").is_file(): return ["no library.json"]
    whole = json.loads((library / "library.json").read_text("utf-8"))
    faults = schema_faults(whole, "library.schema.json")
    ids = [case["id"] for case in whole["cases"]]
    if ids != sorted(set(ids)): faults.append("ids are not sorted")
    known = {"data/ro-crate-metadata.json"}
    for case in whole["cases"]:
        folder = library / "data" / case["id"]
        file = folder / "record.json"
        if not file.is_file() or file.stat().st_size != case["record"]["bytes"] or sha256(file) != case["record"]["sha256"]:
            faults.append(f"{file} is not what library.json states")
            continue
        record = json.loads(file.read_text("utf-8"))
        faults += schema_faults(record, "library-case.schema.json")
        if [record[key] for key in ("id", "version", "title")] != [case[key] for key in ("id", "version", "title")]:
            faults.append(f"{file}: id, version or title")
        if [len(record["files"]), sum(f["bytes"] for f in record["files"])] != [case["files"], case["bytes"]]:
            faults.append(f"{file}: counts")
        for one in record["files"]:
            path = folder / one["path"]
            known.add(path.relative_to(library).as_posix())
            if path.is_symlink() or not path.is_file() or path.stat().st_size != one["bytes"] or sha256(path) != one["sha256"]:
                faults.append(f"{path} is not what its record states")
        known |= {f"data/{case['id']}/{name}" for name in ("record.json", "ro-crate-metadata.json")}
        faults += crate_faults(folder / "ro-crate-metadata.json")
    there = {p.relative_to(library).as_posix() for p in (library / "data").rglob("*") if not p.is_dir()}
    faults += [f"{path} is listed by nothing" for path in there - known]
    return faults + list(bag_faults(library)) + list(crate_faults(library / "data/ro-crate-metadata.json"))
