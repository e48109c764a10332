# SPDX-License-Identifier: Apache-2.0
"""The query in the part of Python that NVIDIA Warp compiles.

A function returns what C writes through pointers. Types are strict in Warp: no operation mixes two, and a variable that a
loop changes is no literal at first. A choice is `wp.where`, of which both sides are computed."""
import re

from pycparser import c_ast

from c_query import Expression, Names, root_of
from writer import Writer

TYPES = {"float": "wp.float32", "int": "wp.int32", "word": "wp.uint32", "words": "wp.uint32", "bits": "wp.uint32"}
VECTORS = {3: "wp.vec3", 4: "wp.vec4", 8: "blob_device_floats"}
LOAD, NUMBER = "blob_device_load(", "blob_device_number("
BUFFER = "buffer: wp.array(dtype=wp.uint32)"

HEAD = '''\
# SPDX-License-Identifier: Apache-2.0
"""libblob's query for NVIDIA Warp, with blob_query_points() and blob_query_exact_points(), a thread for each tool point.

Generated from blob_device_exact.h and the headers that it includes, which explain each function and the buffer, by
libblob/device/translate/translate.py; change those. A pointer of C into the buffer is the index of a
word here: `words` is that of the buffer's first word, 0 unless other data lie before it. Functions
return what C writes through pointers, after their result. Needs wp.where and wp.cast (Warp 1.7).
"""
import warp as wp

# as the library rounds: no multiplication and addition become one; nothing is differentiated
wp.set_module_options({"fuse_fp": False, "enable_backward": False})
'''

LOADS = '''

@wp.func
def blob_device_load(buffer: wp.array(dtype=wp.uint32), index: wp.uint32):
    return buffer[wp.int32(index)]


@wp.func
def blob_device_number(buffer: wp.array(dtype=wp.uint32), index: wp.uint32):
    return wp.cast(buffer[wp.int32(index)], wp.float32)'''

KERNEL = '''

@wp.kernel
def blob_{name}_points(
    buffer: wp.array(dtype=wp.uint32),
    vessel: wp.uint32,
    flags: wp.uint32,
    point: wp.array(dtype=wp.vec3),
    cursor: wp.array(dtype=wp.uint32),
    distance: wp.array(dtype=wp.float32),
    normal: wp.array(dtype=wp.vec3),
    value: wp.array(dtype=wp.float32),
    gradient: wp.array(dtype=wp.vec3),
    state: wp.array(dtype=wp.uint32),
):
    """Points, mm; cursors are read and moved. Answers of blob_device_{name}(): distance in mm and
    outward normal, f and its gradient, {states}."""
    i = wp.tid()
    sample = blob_device_sample()
    node = cursor[i]
    node, sample = blob_device_{name}(buffer, wp.uint32(0), vessel, flags, point[i], node, sample)
    cursor[i] = node
    distance[i] = sample.distance
    normal[i] = sample.normal
    value[i] = sample.value
    gradient[i] = sample.gradient
    state[i] = sample.state
'''
TAIL = (KERNEL.format(name="query", states="BLOB_DEVICE_INSIDE or 0")
        + KERNEL.format(name="query_exact", states="BLOB_DEVICE_INSIDE and _NOT_CONVERGED"))


class Warp(Writer):
    indentation = 2
    breaks_at = 1
    operators = {"&&": "and", "||": "or"}
    negation = "not "
    square_root = "wp.sqrt"

    def text(self):
        self.lines = [HEAD.rstrip("\n"), ""]
        for name, value in self.query.constants.items():
            value = f"wp.uint32({value[:-1]})" if value.endswith("u") else value
            self.lines.append(f"{name} = wp.constant({value})")
        self.lines += ["", "blob_device_floats = wp.types.vector(length=8, dtype=wp.float32)",
                       "blob_device_nodes = wp.types.vector(length=24, dtype=wp.uint32)"]
        for name, fields in self.query.records.items():
            self.lines += ["", "", "@wp.struct", f"class blob_device_{name}:"]
            self.lines += [f"    {field}: {self.type(kind)}" for field, kind in fields.items()]
        self.lines += LOADS.split("\n")
        for function in self.query.functions.values():
            if function.name != "blob_device_float":
                self.function(function)
        return "\n".join(self.lines) + "\n" + TAIL

    def type(self, kind):
        if isinstance(kind, tuple):
            return VECTORS.get(kind[2], "blob_device_nodes")
        return TYPES.get(kind, f"blob_device_{kind}")

    # ------------------------------------------------------------ expressions

    @staticmethod
    def literal(number, kind, text=None):
        if kind == "float":
            text = text or str(number)
            return text if "." in text or "e" in text else text + ".0"
        return f"wp.uint32({text or number})" if kind in ("word", "words") else str(number)

    def conversion(self, text, wanted):
        return f"{self.type(wanted)}({text})"

    @staticmethod
    def variable(name):
        return name

    @staticmethod
    def choice(condition, then, other):
        return Expression(f"wp.where({condition.text}, {then.text}, {other.text})", then.type)

    def reinterpreted(self, text, wanted):
        if text.startswith(LOAD) and text.find(")") == len(text) - 1 - (text.count("(") - 1):
            return NUMBER + text[len(LOAD):]
        return f"wp.cast({text}, {self.type(wanted)})"

    @staticmethod
    def loaded(index):
        return f"{LOAD}buffer, {index})"

    def call(self, function, values):
        """The call, or the name of its result where it has outputs and stands on a line before."""
        texts = ["buffer"] if self.query.reads_buffer(function) else []
        targets = [] if function.result == "void" else [self.temporary("result")]
        copies = []
        for value in values:
            if isinstance(value, str):
                texts.append(value)
                continue
            place = self.expression(value).text
            texts.append(place)
            if "." in place:
                copies.append((place, self.temporary("copy")))
                place = copies[-1][1]
            targets.append(place)
        call = f"{function.name}({', '.join(texts)})"
        if all(isinstance(value, str) for value in values):
            return call
        self.line(f"{', '.join(targets)} = {call}")
        for place, copy in copies:
            self.line(f"{place} = {copy}")
        return "" if function.result == "void" else targets[0]

    def temporary(self, name):
        self.temporaries += 1
        return f"{name}_{self.temporaries}"

    # ------------------------------------------------------------ statements

    @staticmethod
    def bracketed(text):
        """Python goes on in the next line within parentheses alone."""
        head, value = re.fullmatch(r"(return |[^(]* [-+*]?= |)(.*)", text).groups()
        spaced, depth = False, 0
        for letter in value:
            depth += (letter in "([") - (letter in ")]")
            spaced = spaced or (depth == 0 and letter == " ")
            if depth == 0 and letter == ",":
                return text
        return f"{head}({value})" if head and spaced else text

    def begin(self, function):
        parts = [BUFFER] if self.query.reads_buffer(function) else []
        parts += [f"{p.name}: {self.type(p.type)}" for p in function.parameters]
        self.lines += ["", "", "@wp.func"]
        self.line(f"def {function.name}({', '.join(parts)}):")
        self.depth = 1

    def end(self, function):
        if self.outputs and not isinstance(function.body.block_items[-1], c_ast.Return):
            self.give(None)
        self.depth = 0

    def declare(self, name, kind, value, _):
        if value is None:
            value = {"float": "0.0", "int": "0", "word": "wp.uint32(0)", "bits": "wp.uint32(0)"}.get(kind, self.type(kind) + "()")
        self.assign(name, "=", value)

    def assign(self, place, op, value):
        if op == "=" and re.fullmatch(r"-?\d+", value):
            value = f"wp.int32({value})"
        elif op == "=" and re.fullmatch(r"-?[\d.]+(e-?\d+)?", value):
            value = f"wp.float32({value})"
        self.line(f"{place} {op} {value}")

    def alone(self, call):
        if call:
            self.line(call)

    def give(self, value):
        texts = ([] if value is None else [self.type(self.result) + f"({value})" if re.fullmatch(r"-?[\d.]+", value) else value])
        self.line("return " + ", ".join(texts + self.outputs))

    def do_if(self, node, word="if"):
        self.line(f"{word} {self.value(node.cond, 'bool')}:")
        self.block(node.iftrue)
        if isinstance(node.iffalse, c_ast.If):
            self.do_if(node.iffalse, "elif")
        elif node.iffalse is not None:
            self.line("else:")
            self.block(node.iffalse)

    def count(self, counter, kind, start, bound, body):
        last = self.value(bound, kind)
        is_fixed = isinstance(bound, c_ast.Constant) or root_of(bound) not in Names(body, self.query.functions).changed
        if is_fixed and kind == "int":
            self.line(f"for {counter} in range({last if start == '0' else f'{start}, {last}'}):")
            self.block(body)
        elif is_fixed:
            index = self.temporary("index")
            self.line(f"for {index} in range(wp.int32({last})):")
            self.depth += 1
            self.line(f"{counter} = {self.conversion(index, kind)}")
            self.depth -= 1
            self.block(body)
        else:
            self.assign(counter, "=", start)
            self.line(f"while {counter} < {last}:")
            self.block(body)
            self.depth += 1
            self.line(f"{counter} += {self.literal(1, kind)}")
            self.depth -= 1

    def do_break(self, _):
        self.line("break")

    def do_continue(self, _):
        self.line("continue")
