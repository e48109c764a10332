#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the stubs of the package lumen: write_stubs.py TEMPLATES PACKAGE

A line "{options COMMAND -NAME...}" of a template becomes the keyword arguments of that command's rows, without those
that are named; "{run}" becomes progress, threads and strict; "{groups}" the classes of lumen.options.
PACKAGE is the built package, which lists the rows."""
import pathlib, re, sys

LINE = re.compile(r"^(?P<indent> *)\{(?P<what>run|options (?P<command>\w+)(?P<without>( -\S+)*))\}\n", re.MULTILINE)
RUN = ("progress: Optional[Report] = None", "threads: Optional[int] = None", "strict: bool = False")


def main():
    templates, package = map(pathlib.Path, sys.argv[1:3])
    sys.path.insert(0, str(package.parent))
    from lumen import _options  # the built package, of the folder that is given

    def keywords(match):
        lines = RUN
        if match["command"]:
            rows = _options.mesh_rows() if match["command"] == "mesh" else _options.rows_of(match["command"])
            without = {word[1:] for word in match["without"].split()}
            lines = [f"{_options.keyword_of(row['name'])}: Optional[{kind(row)}] = None"
                     for row in rows if row["name"] not in without]
        return "".join(f"{match['indent']}{line},\n" for line in lines)

    def kind(row):
        kinds = re.split(r" \| ", _options.type_of(row))
        return kinds[0] if len(kinds) == 1 else f"Union[{', '.join(kinds)}]"

    def classes():
        for name, rows in sorted(_options.group_rows().items()):
            yield f"class {name}(TypedDict, total=False):\n"
            yield from (f"    {_options.keyword_of(row['name'])}: {kind(row)}\n" for row in rows)

    for template in sorted(templates.glob("*.pyi.in")):
        text = LINE.sub(keywords, template.read_text(encoding="utf-8")).replace("{groups}\n", "".join(classes()))
        (package / template.name[:-3]).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
