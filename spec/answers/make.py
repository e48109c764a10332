#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the JSON Schemas of the answers from answers.txt.

make.py FOLDER   writes FOLDER/NAME.schema.json for each line "== NAME  TITLE  DESCRIPTION", with the lines below it

A line is KEY  TYPE  DESCRIPTION, with two spaces between the columns; the description may be missing. Keys of an object inside are
indented by two more. All keys are required and no others are allowed; those that end in * come all together or not at all.
$NAME  TYPE is a part with a name. TYPE is one of

  integer number string boolean null   of JSON; with a range as >=0, >0 or (0..1), or a pattern as string/REGEX/; or several, a|b
  "a"|"b"|null                         one of these values
  {} {TYPE}                            the object of the indented lines; an object with values of the type by any name
  [TYPE] [TYPE]3 [TYPE]+               an array; of 3 elements; of at least one
  NAME ANSWER.KEY                      a part of the same answer, or of the answer `parts`; the type of a key of another answer
  TYPE?                                or null"""
import argparse, json, pathlib, re

RANGE = re.compile(r"(integer|number)(?:>=([-.\d]+)|>([-.\d]+)|\(([-.\d]+)\.\.([-.\d]+)\))")
PLAIN = {"integer", "number", "string", "boolean", "null"}


def or_null(schema):
    if "enum" in schema: return {"enum": schema["enum"] + [None]}
    if schema.get("type") in PLAIN: return {**schema, "type": [schema["type"], "null"]}
    return {"anyOf": [schema, {"type": "null"}]}


def array(text, inner):
    content, _, number = text[1:].rpartition("]")
    out = {"type": "array", "items": schema_of(content, *inner)}
    if number: out["minItems"] = 1 if number == "+" else int(number)
    if number.isdigit(): out["maxItems"] = int(number)
    return out


def schema_of(text, below, parts):
    """The schema of a type. `below`: the keys of an object in it; `parts`: where each part with a name is."""
    if text.endswith("?"): return or_null(schema_of(text[:-1], below, parts))
    if text[0] == "[": return array(text, (below, parts))
    if text == "{}": return below
    if text[0] == "{": return {"type": "object", "additionalProperties": schema_of(text[1:-1], below, parts)}
    if text.startswith("string/"): return {"type": "string", "pattern": text[len("string/"):-1]}
    if text[0] == '"':
        words = list(map(json.loads, text.split("|")))
        return {"enum": words} if len(words) > 1 else {"const": words[0]}
    if found := RANGE.fullmatch(text):
        least, above, low, high = (number and json.loads(number) for number in found.groups()[1:])
        limits = {"minimum": low if least is None else least, "exclusiveMinimum": above, "maximum": high}
        return {"type": found[1], **{key: limit for key, limit in limits.items() if limit is not None}}
    words = text.split("|")
    if set(words) <= PLAIN: return {"type": words if len(words) > 1 else text}
    answer, dot, key = text.partition(".")
    return {"$ref": f"{answer}.schema.json#/properties/{key}" if dot else parts[text]}


def object_of(lines, indent, parts):
    """The schema of the object, and the parts, that the first lines with an indent or a deeper one state; takes these off the list."""
    keys, named, together = {}, {}, []
    while lines and lines[0].startswith(indent):
        key, text, *description = lines.pop(0).strip().split("  ")
        below, _ = object_of(lines, indent + "  ", parts)
        schema = {**({"description": description[0]} if description else {}), **schema_of(text, below, parts)}
        if key.endswith("*"): together.append(key[:-1])
        if key.startswith("$"): named[key[1:]] = schema
        else: keys[key.rstrip("*")] = schema
    out = {"type": "object", "required": [key for key in keys if key not in together], "additionalProperties": False}
    if together: out["dependentRequired"] = {key: [other for other in together if other != key] for key in together}
    return {**out, "properties": keys}, named


def answers(text):
    """The schemas, by the names of their files."""
    out, shared = {}, {}
    for part in re.split(r"^== ", text, flags=re.M)[1:]:
        head, *lines = part.rstrip("\n").split("\n")
        name, title, *description = head.split("  ")
        own = {line[1:].split("  ")[0]: f"#/$defs/{line[1:].split('  ')[0]}" for line in lines if line.startswith("$")}
        if name == "parts": shared = {key: f"parts.schema.json{place}" for key, place in own.items()}
        schema, parts = object_of(lines, "", {**shared, **own})
        out[f"{name}.schema.json"] = {
            "$schema": "https://json-schema.org/draft/2020-12/schema", "$id": f"{name}.schema.json", "title": title,
            **({"description": description[0]} if description else {}), **(schema if schema["properties"] else {}),
            **({"$defs": parts} if parts else {})}
    return out


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    folder = parser.parse_args().folder
    folder.mkdir(parents=True, exist_ok=True)
    for name, schema in answers((pathlib.Path(__file__).parent / "answers.txt").read_text()).items():
        (folder / name).write_text(json.dumps(schema, indent=2, ensure_ascii=False) + "\n")


if __name__ == "__main__":
    main()
