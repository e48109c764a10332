# SPDX-License-Identifier: Apache-2.0
"""The functions of blob_device.h as a tree of C (python3-pycparser), and the types of their expressions.

A pointer into the buffer is the index of a word there. A parameter that is a pointer to const is a value; any other pointer is an
output, which is read, too. The part of C is that of the header: no `goto`, no `switch`, no `while`, and `for` loops that count upwards by one."""
import pathlib
import re
from collections import namedtuple

from pycparser import c_ast, c_parser

INCLUDE = pathlib.Path(__file__).resolve().parents[2] / "include"
HEADERS = ("blob_device_model.h", "blob_device_lanes.h", "blob_device_blend.h", "blob_device.h", "blob_device_wall.h",
           "blob_device_exact.h")
PREFIX = "blob_device_"
BITS = "bits"  # the union that shows a float as a word
AXES = 3  # elements of each array that is a parameter

#: Text of an expression, its type, how tightly it binds, the number if it is an integer literal.
Expression = namedtuple("Expression", "text type rank literal", defaults=(9, None))
#: kind: "in" for a value, "out" for what the function changes.
Parameter = namedtuple("Parameter", "name type kind")
Function = namedtuple("Function", "name result parameters body")

RANK = {"||": 1, "&&": 2, "==": 3, "!=": 3, "<": 3, ">": 3, "<=": 3, ">=": 3, "|": 4, "&": 4, "<<": 5, ">>": 5, "+": 6,
        "-": 6, "*": 7, "/": 7}


def array(element, count):
    return ("array", element, count)


def source_text():
    """The text of all headers without comments and directives, and the constants that they define."""
    text = "".join((INCLUDE / name).read_text(encoding="utf-8") for name in HEADERS)
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.S)
    constants = dict(re.findall(r"^#define (BLOB_DEVICE_\w+) ((?:0x[0-9a-f]+|\d+)u?) *$", text, flags=re.M))
    text = re.sub(r"^#.*$|^typedef \w+ blob_device_word;$", "", text, flags=re.M)
    text = re.sub(r"\bBLOB_DEVICE_(FN|GLOBAL|UNROLL)\b", "", text).replace("BLOB_DEVICE_SQRT", "sqrt")
    return "typedef unsigned blob_device_word;\n" + text, constants


def type_of(node):
    """The type that a declarator states; that of a pointer is ("pointer", type, is const)."""
    if isinstance(node, c_ast.TypeDecl):
        name = node.type.names[0] if isinstance(node.type, c_ast.IdentifierType) else node.type.name
        return name[len(PREFIX):] if name.startswith(PREFIX) else name
    if isinstance(node, c_ast.ArrayDecl):
        size = int(node.dim.value) if isinstance(node.dim, c_ast.Constant) else node.dim.name
        return array(type_of(node.type), size)
    if isinstance(node, c_ast.PtrDecl):
        return ("pointer", type_of(node.type), "const" in node.type.quals)
    raise ValueError(f"no type: {node}")


class Names(c_ast.NodeVisitor):
    """Names that a part of a function indexes, and those that it counts with."""

    def __init__(self, node):
        self.indexed, self.counters = set(), set()
        self.visit(node)

    def visit_ArrayRef(self, node):
        if isinstance(node.name, c_ast.ID):
            self.indexed.add(node.name.name)
        self.generic_visit(node)

    def visit_For(self, node):
        self.counters.add(node.init.lvalue.name)
        for part in (node.cond, node.stmt):
            self.visit(part)


class Query:
    """Records, functions and constants of the headers, in their order."""

    def __init__(self):
        text, self.constants = source_text()
        self.records, self.functions = {}, {}
        for node in c_parser.CParser().parse(text):
            if isinstance(node, c_ast.FuncDef):
                self.add_function(node)
            elif isinstance(node, c_ast.Typedef) and isinstance(node.type.type, c_ast.Struct):
                self.records[node.type.type.name[len(PREFIX):]] = {
                    field.name: type_of(field.type) for field in node.type.type.decls}

    def add_function(self, node):
        indexed = Names(node.body).indexed
        parameters = []
        for declaration in node.decl.type.args.params:
            kind, name = type_of(declaration.type), declaration.name
            mode = "in"
            if kind[0] == "pointer":
                mode = "in" if kind[2] else "out"
                # a number by its address is an output; an array if it is indexed or only read
                kind = array("float", AXES) if kind[1] == "float" and (kind[2] or name in indexed) else kind[1]
            parameters.append(Parameter(name, kind, mode))
        name = node.decl.name
        self.functions[name] = Function(name, type_of(node.decl.type.type), parameters, node.body)
