# SPDX-License-Identifier: Apache-2.0
"""The query in WGSL, the language of WebGPU's shaders."""
from pycparser import c_ast

from c_query import Expression
from writer import Writer

MOST_WRITTEN_OUT = 4  # turns of a loop
TYPES = {"float": "f32", "int": "i32", "word": "u32", "words": "u32", "bits": "u32", "bool": "bool"}

HEAD = """\
// SPDX-License-Identifier: Apache-2.0
// libblob's query in WGSL, blob_query_points() and blob_query_exact_points(): an invocation for each
// tool point. Generated from blob_device_exact.h and the headers that it includes, which explain each function and the buffer, by
// libblob/device/translate/translate.py; change those.
//
// A pointer of C into the buffer is the index of a word here: words is that of the buffer's first
// word, 0 unless other data lie before it. Outputs are pointers to variables of a function. Points
// are finite: WGSL promises nothing for NaN and infinities.

@group(0) @binding(0) var<storage, read> blob_device_buffer: array<u32>;
"""

TAIL = """
// ---------------------------------------------------------------- kernels

// Arguments of a dispatch; groups_x is the number of its workgroups along x.
struct blob_query_batch {
  vessel: u32,
  flags: u32,
  count: u32,
  groups_x: u32,
}

// point: x, y, z of each point, mm. Cursors are read and moved. answer: distance in mm and
// outward normal; value: f and its gradient; state: BLOB_DEVICE_INSIDE and _NOT_CONVERGED.
@group(0) @binding(1) var<uniform> blob_batch: blob_query_batch;
@group(0) @binding(2) var<storage, read> blob_point: array<f32>;
@group(0) @binding(3) var<storage, read_write> blob_cursor: array<u32>;
@group(0) @binding(4) var<storage, read_write> blob_answer: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> blob_value: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> blob_state: array<u32>;
"""

KERNEL = """
@compute @workgroup_size(64)
fn blob_%(name)s_points(@builtin(global_invocation_id) id: vec3<u32>) {
  let i = id.y * blob_batch.groups_x * 64u + id.x;
  if (i >= blob_batch.count) {
    return;
  }
  let at = array<f32, 3>(blob_point[3u * i], blob_point[3u * i + 1u], blob_point[3u * i + 2u]);
  var node = blob_cursor[i];
  var s: blob_device_sample;
  blob_device_%(name)s(0u, blob_batch.vessel, blob_batch.flags, at, &node, &s);
  blob_cursor[i] = node;
  blob_answer[i] = vec4<f32>(s.distance, s.normal[0], s.normal[1], s.normal[2]);
  blob_value[i] = vec4<f32>(s.value, s.gradient[0], s.gradient[1], s.gradient[2]);
  blob_state[i] = s.state;
}
"""
TAIL += KERNEL % {"name": "query"} + KERNEL % {"name": "query_exact"}


class Wgsl(Writer):
    indentation = 1
    breaks_at = 0
    operators = {}
    negation = "!"
    square_root = "sqrt"

    def text(self):
        self.lines = [HEAD.rstrip("\n"), ""]
        for name, value in self.query.constants.items():
            kind = "u32" if value.endswith("u") else "i32"
            self.lines.append(f"const {name}: {kind} = {value};")
        for name, fields in self.query.records.items():
            self.lines += ["", f"struct blob_device_{name} {{"]
            self.lines += [f"  {field}: {self.type(kind)}," for field, kind in fields.items()] + ["}"]
        for function in self.query.functions.values():
            if function.name != "blob_device_float":
                self.function(function)
        return "\n".join(self.lines) + "\n" + TAIL

    def type(self, kind):
        if kind in TYPES:
            return TYPES[kind]
        if isinstance(kind, tuple):
            return f"array<{self.type(kind[1])}, {kind[2]}>"
        return f"blob_device_{kind}"

    # ------------------------------------------------------------ expressions

    @staticmethod
    def literal(number, kind, text=None):
        if kind == "float":
            text = text or str(number)
            return (text if "." in text or "e" in text else text + ".0") + "f"
        return (text or str(number)) + ("u" if kind in ("word", "words") else "")

    def conversion(self, text, wanted):
        return f"{self.type(wanted)}({text})"

    def variable(self, name):
        return f"(*{name})" if name in self.outputs else name

    def choice(self, condition, then, other):
        return Expression(f"select({other.text}, {then.text}, {condition.text})", then.type)

    def reinterpreted(self, text, wanted):
        return f"bitcast<{self.type(wanted)}>({text})"

    @staticmethod
    def loaded(index):
        return f"blob_device_buffer[{index}]"

    def call(self, function, values):
        return f"{function.name}({', '.join(v if isinstance(v, str) else self.address(v) for v in values)})"

    def address(self, target):
        """A pointer to a variable. One to a member, which not every implementation takes, is that of a copy."""
        text = self.expression(target).text
        if text.startswith("(*") and text.endswith(")"):
            return text[2:-1]
        if "." not in text:
            return "&" + text
        self.temporaries += 1
        copy = f"copy_{self.temporaries}"
        self.line(f"var {copy} = {text};")
        self.copies.append((text, copy))
        return "&" + copy

    # ------------------------------------------------------------ statements

    def begin(self, function):
        self.copies = []
        parts = [f"{p.name}: " + (f"ptr<function, {self.type(p.type)}>" if p.kind == "out" else self.type(p.type))
                 for p in function.parameters]
        result = "" if function.result == "void" else f" -> {self.type(function.result)}"
        self.lines.append("")
        self.line(f"fn {function.name}({', '.join(parts)}){result} {{")
        self.depth = 1

    def end(self, _):
        self.depth = 0
        self.line("}")

    def declare(self, name, kind, value, is_constant):
        word = "let" if is_constant else "var"
        self.line(f"{word} {name}: {self.type(kind)}" + ("" if value is None else f" = {value}") + ";")

    def assign(self, place, op, value):
        self.line(f"{place} {op} {value};")

    def alone(self, call):
        self.line(call + ";")
        for text, copy in self.copies:
            self.line(f"{text} = {copy};")
        self.copies = []

    def give(self, value):
        self.line("return;" if value is None else f"return {value};")

    def do_if(self, node, before=""):
        self.line(f"{before}if ({self.value(node.cond, 'bool')}) {{")
        self.block(node.iftrue)
        if isinstance(node.iffalse, c_ast.If):
            self.do_if(node.iffalse, "} else ")
            return
        if node.iffalse is not None:
            self.line("} else {")
            self.block(node.iffalse)
        self.line("}")

    def count(self, counter, kind, start, bound, body):
        """A loop over elements of an array is written out: some implementations index values by constants alone."""
        if isinstance(bound, c_ast.Constant) and int(bound.value) <= MOST_WRITTEN_OUT:
            for value in range(int(start), int(bound.value)):
                self.known[counter] = value
                self.statements(body)
            del self.known[counter]
            return
        self.line(f"for (var {counter}: {self.type(kind)} = {start}; {counter} < {self.value(bound, kind)}; "
                  f"{counter} += {self.literal(1, kind)}) {{")
        self.block(body)
        self.line("}")

    def do_break(self, _):
        self.line("break;")

    def do_continue(self, _):
        self.line("continue;")
