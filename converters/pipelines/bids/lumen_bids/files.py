# SPDX-License-Identifier: Apache-2.0
"""Files that appear whole or not at all, digests, and JSON."""
import hashlib
import json
import os
import pathlib
import tempfile

from .errors import FAILED, Fault


def write_text(text, file):
    """Writes beside the file, flushes, and renames. Raises Fault."""
    file = pathlib.Path(file)
    name = None
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(prefix=".lumen-", suffix=file.suffix, dir=file.parent)
        with os.fdopen(handle, "w", encoding="utf-8") as out:
            out.write(text)
            out.flush()
            os.fsync(out.fileno())
        os.chmod(name, 0o644)
        os.replace(name, file)
    except OSError as error:
        if name is not None and os.path.exists(name):
            os.unlink(name)
        raise Fault(f"{file}: {error.strerror}", FAILED) from error


def write_json(value, file):
    write_text(json.dumps(value, indent=2, ensure_ascii=False) + "\n", file)


def read_json(file, what):
    """The object in a JSON file; `what` names its role. Raises Fault."""
    try:
        value = json.loads(pathlib.Path(file).read_text(encoding="utf-8"))
    except OSError as error:
        raise Fault(f"{file}: this {what} cannot be read: {error.strerror}") from error
    except ValueError as error:
        raise Fault(f"{file}: found no JSON, expected a {what}: {error}") from error
    if not isinstance(value, dict):
        raise Fault(f"{file}: found {type(value).__name__}, expected a JSON object")
    return value


def digest(file):
    """SHA-256 of a file. Raises Fault."""
    found = hashlib.sha256()
    try:
        with open(file, "rb") as data:
            for block in iter(lambda: data.read(1 << 20), b""):
                found.update(block)
    except OSError as error:
        raise Fault(f"{file}: cannot be read: {error.strerror}") from error
    return found.hexdigest()


def digest_of(value):
    """SHA-256 of a value as JSON with sorted keys."""
    text = json.dumps(value, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()
