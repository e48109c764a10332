# SPDX-License-Identifier: Apache-2.0
"""The rules of 3D Slicer's Execution Model for the XML of a command-line module, written from its documentation and from the
source of its parser (SlicerExecutionModel, ModuleDescriptionParser.cxx, commit 57d54ad): a long flag has no dashes inside, and each
kind of parameter has attributes of its own."""
import re
import xml.etree.ElementTree as ElementTree

HEAD = ["category", "index", "title", "description", "version", "documentation-url", "license", "contributor", "acknowledgements", "logo"]
REQUIRED = ["category", "title", "description", "version", "license", "contributor"]
SCALARS = {"integer": int, "float": float, "double": float}
VALUES = {"boolean", "string", "file", "directory", "image", "geometry", "pointfile", "table", "transform", "measurement", "point", "region",
          *SCALARS, *(name + "-vector" for name in (*SCALARS, "string")), *(name + "-enumeration" for name in (*SCALARS, "string"))}
CHANNELLED = {"file", "directory", "image", "geometry", "pointfile", "table", "transform", "measurement"}
ATTRIBUTES = {"file": {"multiple", "fileExtensions"}, "directory": {"multiple"}, "boolean": {"hidden"}, "image": {"multiple", "fileExtensions", "type", "hidden", "reference"},
              "geometry": {"multiple", "aggregate", "fileExtensions", "type", "reference"}, "transform": {"multiple", "fileExtensions", "type", "reference"},
              "table": {"multiple", "fileExtensions", "type", "hidden", "reference"}, "measurement": {"multiple", "fileExtensions", "type", "hidden", "reference"},
              "point": {"multiple", "coordinateSystem"}, "region": {"multiple", "coordinateSystem"}, "pointfile": {"multiple", "fileExtensions", "coordinateSystem"}}
SCALAR_ATTRIBUTES = {"multiple", "hidden"}
MEMBERS = {"name", "flag", "longflag", "description", "label", "default", "constraints", "channel", "index", "element"}
TYPES = {"image": {"scalar", "label", "tensor", "diffusion-weighted", "vector", "model", "any"}, "geometry": {"fiberbundle", "model"}}
NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*$")


def text_of(element, tag):
    return (element.findtext(tag) or "").strip()


def check_head(root):
    if root.tag != "executable": yield f"the root is <{root.tag}>, not <executable>"
    tags = [child.tag for child in root]
    for tag in tags:
        if tag not in [*HEAD, "parameters"]: yield f"<{tag}> is no element of <executable>"
    for tag in REQUIRED:
        if text_of(root, tag) == "": yield f"<{tag}> is missing or empty"
    known = [tag for tag in tags if tag in HEAD]
    if known != [tag for tag in HEAD if tag in known]: yield f"the order is {known}"
    if "parameters" not in tags: yield "there are no parameters"


def check_scalar(parameter, where):
    kind, default, constraints = parameter.tag, text_of(parameter, "default"), parameter.find("constraints")
    if kind == "boolean" and default not in ("true", "false"): yield f"{where}: the default of a boolean is {default!r}"
    if kind in SCALARS:
        try:
            value = SCALARS[kind](default)
        except ValueError:
            yield f"{where}: the default {default!r} is no {kind}"
            return
        if constraints is not None:
            low, high = (float(text_of(constraints, tag) or "nan") for tag in ("minimum", "maximum"))
            if not low <= value <= high: yield f"{where}: the default {value} is not within {low} to {high}"
    elif constraints is not None:
        yield f"{where}: a {kind} has no constraints"
    if kind.endswith("-enumeration") and default not in [e.text for e in parameter.findall("element")]:
        yield f"{where}: the default {default!r} is none of its elements"


def check_parameter(parameter):
    name, where = text_of(parameter, "name"), f"<{parameter.tag}> {text_of(parameter, 'name')}"
    if parameter.tag not in VALUES: yield f"{where}: there is no such kind"
    if not NAME.match(name): yield f"{where}: the name is no identifier of C"
    for tag in ("label", "description"):
        if text_of(parameter, tag) == "": yield f"{where}: <{tag}> is missing or empty"
    for child in parameter:
        if child.tag not in MEMBERS: yield f"{where}: <{child.tag}> is no member"
        if len(parameter.findall(child.tag)) > 1 and child.tag != "element": yield f"{where}: <{child.tag}> is there twice"
    for attribute in parameter.keys():
        if attribute not in ATTRIBUTES.get(parameter.tag, SCALAR_ATTRIBUTES): yield f"{where}: there is no attribute {attribute}"
    flags, index = [text_of(parameter, tag) for tag in ("flag", "longflag")], text_of(parameter, "index")
    if flags[1] == "" and index == "": yield f"{where}: it has neither a long flag nor an index"
    if flags[1] and not NAME.match(flags[1].lstrip("-")): yield f"{where}: the long flag {flags[1]} is no identifier"
    if any(flags) and index != "": yield f"{where}: it has a flag and an index"
    if flags[0] and len(flags[0].lstrip("-")) != 1: yield f"{where}: a flag is one letter"
    if (parameter.tag in CHANNELLED) != (text_of(parameter, "channel") in ("input", "output")): yield f"{where}: its channel is wrong"
    if parameter.get("type") not in {None, *TYPES.get(parameter.tag, ())}: yield f"{where}: there is no type {parameter.get('type')}"
    for ending in filter(None, parameter.get("fileExtensions", "").split(",")):
        if not ending.startswith("."): yield f"{where}: the ending {ending} has no point"
    if parameter.get("coordinateSystem", "lps") not in ("lps", "ras", "ijk"): yield f"{where}: there is no such coordinate system"
    yield from check_scalar(parameter, where)


def faults_of(xml):
    """Sentences on what is wrong with the text of a module's XML; none: it is right."""
    try:
        root = ElementTree.fromstring(xml)
    except ElementTree.ParseError as error:
        return [f"no XML: {error}"]
    faults = list(check_head(root))
    parameters = []
    for group in root.iter("parameters"):
        for tag in ("label", "description"):
            if text_of(group, tag) == "": faults.append(f"a group of parameters has no <{tag}>")
        parameters += [child for child in group if child.tag not in ("label", "description")]
    for parameter in parameters: faults += check_parameter(parameter)
    names = [text_of(parameter, tag) for tag in ("name",) for parameter in parameters]
    flags = [text_of(parameter, tag) for parameter in parameters for tag in ("flag", "longflag") if text_of(parameter, tag)]
    indices = sorted(int(text_of(parameter, "index")) for parameter in parameters if text_of(parameter, "index"))
    if len(set(names)) != len(names): faults.append("two parameters have one name")
    if len(set(flags)) != len(flags): faults.append("two parameters have one flag")
    if indices != list(range(len(indices))): faults.append(f"indices are {indices}")
    return faults
