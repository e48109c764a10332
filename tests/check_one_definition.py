#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that a name of a type stands for one type in all of the code.

check_one_definition.py

The linker keeps one copy of what a template makes of a type, such as a vector's growth, and takes types for the same
by their names alone: two structs of one name, each right in its own file, break each other. A type counts if it is
defined in a namespace that has a name; types within types, and those in unnamed namespaces, do not clash.
Exit status: 0 each name has one definition, 1 some name has two."""
import collections, pathlib, re, sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDERS = ("formats", "libblob", "converters", "viewer", "packages", "tests")
# libblob's back ends define the same vector types, each in a file that the others do not see.
ONE_OF_SEVERAL = re.compile(r"libblob/src/simd/f8_\w+\.h")

NO_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<!\w)\'(?:\\.|[^\'\\\n])\'', re.S)
BRACES = re.compile(r"\bnamespace\s+(?P<space>[\w:]*)\s*\{"
                    r"|\b(?:struct|class|union|enum(?:\s+class)?)\s+(?P<type>\w+)(?:\s+final)?\s*(?::[^:;{()][^;{()]*)?\{"
                    r"|[{}]")


def types(text):
    """The full names of the types that a file defines in namespaces with names, or in none."""
    around = []  # a name of a namespace, or None for any other block
    for match in BRACES.finditer(NO_CODE.sub(" ", text)):
        if match[0] == "}":
            del around[-1:]
            continue
        if match["type"] and all(around):
            yield "::".join([*around, match["type"]])
        around.append(match["space"] or None)


def main():
    files = [f.relative_to(ROOT).as_posix() for folder in FOLDERS for f in sorted((ROOT / folder).rglob("*"))
             if f.suffix in (".h", ".cpp") and "node_modules" not in f.parts]
    files = [f for f in files if not ONE_OF_SEVERAL.fullmatch(f)]
    places = collections.defaultdict(list)
    for name in files:
        for kind in types((ROOT / name).read_text()):
            # programs and tests in C and their like each are a world of their own
            if "::" in kind:
                places[kind].append(name)
    twice = {kind: where for kind, where in places.items() if len(where) > 1}
    for kind, where in sorted(twice.items()):
        print(f"{kind} is defined in {', '.join(where)}: types need names of their own")
    print(f"{len(places)} names of types, {len(twice)} with two definitions")
    return 1 if twice else 0


if __name__ == "__main__":
    sys.exit(main())
