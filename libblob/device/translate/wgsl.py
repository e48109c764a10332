# SPDX-License-Identifier: Apache-2.0
"""The query in WGSL, the language of WebGPU's shaders."""
from pycparser import c_ast

from c_query import BITS, RANK, Expression, Names, type_of

MOST_WRITTEN_OUT = 4  # turns of a loop
COMPARISONS = ("==", "!=", "<", ">", "<=", ">=")
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


class Wgsl:
    """The text of the shader."""

    def __init__(self, query):
        self.query, self.lines, self.depth = query, [], 0
        self.variables, self.outputs, self.counters = {}, [], set()
        self.known = {}  # the value of a counter whose loop is written out
        self.temporaries, self.copies = 0, []

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

    def line(self, text):
        """A line of the text, indented."""
        self.lines.append("  " * self.depth + text)

    # ------------------------------------------------------------ expressions

    def converted(self, e, wanted):
        """An expression as one of another type."""
        words = {"words": "word"}
        if words.get(e.type, e.type) == words.get(wanted, wanted):
            return e
        if e.literal is not None:
            return Expression(self.literal(e.literal, wanted), wanted)
        if wanted == "bool":
            return self.compared("!=", e, self.integer(0))
        if e.type == "bool":
            return self.choice(e, self.converted(self.integer(1), wanted), self.converted(self.integer(0), wanted))
        return Expression(f"{self.type(wanted)}({e.text})", wanted)

    @staticmethod
    def integer(number):
        return Expression(str(number), "int", 9, number)

    def common(self, a, b):
        """Both expressions as the type that C computes in."""
        for kind in ("float", "words", "word", "int"):
            if kind in (a.type, b.type):
                wanted = "word" if kind == "words" else kind
                return self.converted(a, wanted), self.converted(b, wanted), kind
        return a, b, a.type

    def settled(self, e):
        """A literal that stands alone, as an expression of WGSL."""
        return Expression(self.literal(e.literal, "int"), "int") if e.literal is not None else e

    def joined(self, op, a, b, kind):
        """Two expressions about an operator, in the parentheses that WGSL needs."""
        rank = RANK[op]

        def inner(e, is_right):
            if rank >= RANK["+"]:
                is_bare = e.rank > rank or (e.rank == rank and not is_right)
            elif rank in (RANK["|"], RANK["<<"]):
                is_bare = e.rank > RANK["*"]
            else:  # a comparison stands bare within && and ||, but no && within ||
                is_bare = e.rank >= RANK["+"] or rank < e.rank == RANK["=="]
            return e.text if is_bare else f"({e.text})"

        return Expression(f"{inner(a, False)} {op} {inner(b, True)}", kind, rank)

    def compared(self, op, a, b):
        a, b, _ = self.common(a, b)
        return self.joined(op, self.settled(a), self.settled(b), "bool")

    def expression(self, node):
        return getattr(self, "of_" + type(node).__name__.lower())(node)

    def value(self, node, wanted):
        """The text of an expression as a type."""
        return self.settled(self.converted(self.expression(node), wanted)).text

    def of_constant(self, node):
        text = node.value.lower()
        if node.type == "float":
            return Expression(self.literal(float(text.rstrip("f")), "float", text.rstrip("f")), "float")
        if text.endswith("u"):
            return Expression(self.literal(int(text[:-1], 0), "word", text[:-1]), "word")
        return self.integer(int(text, 0))

    def of_id(self, node):
        if node.name in self.query.constants:
            text = self.query.constants[node.name]
            return Expression(node.name, "word") if text.endswith("u") else Expression(node.name, "int")
        if node.name in self.known:
            return self.integer(self.known[node.name])
        kind = self.variables[node.name]
        if kind == BITS:
            raise ValueError("a union is used by its members alone")
        return Expression(self.variable(node.name), kind)

    def of_structref(self, node):
        name = node.name.name if isinstance(node.name, c_ast.ID) else None
        if name is not None and self.variables[name] == BITS:
            word = Expression(self.variable(name), "word")
            return word if node.field.name == "word" else Expression(f"bitcast<f32>({word.text})", "float")
        e = self.expression(node.name)
        return Expression(f"{e.text}.{node.field.name}", self.query.records[e.type][node.field.name])

    def of_arrayref(self, node):
        e = self.expression(node.name)
        if e.type == "words":
            index = self.expression(node.subscript)
            place = e if index.literal == 0 else self.joined("+", e, self.converted(index, "word"), "words")
            return Expression(f"blob_device_buffer[{place.text}]", "word")
        index = self.settled(self.expression(node.subscript))
        return Expression(f"{e.text}[{index.text}]", e.type[1])

    def of_unaryop(self, node):
        e = self.expression(node.expr)
        if node.op == "*":
            return Expression(f"blob_device_buffer[{e.text}]", "word") if e.type == "words" else e
        if node.op == "!":
            if e.type == "int":
                return self.compared("==", e, self.integer(0))
            return Expression(f"!({e.text})", "bool", 8)
        if node.op == "-":
            if e.literal is not None:
                return self.integer(-e.literal)
            return Expression("-" + (e.text if e.rank > 7 else f"({e.text})"), e.type, 8)
        raise ValueError(f"operator {node.op} within an expression")

    def of_binaryop(self, node):
        a, b = self.expression(node.left), self.expression(node.right)
        if node.op in ("&&", "||"):
            return self.joined(node.op, self.converted(a, "bool"), self.converted(b, "bool"), "bool")
        if node.op in COMPARISONS:
            return self.compared(node.op, a, b)
        if node.op in ("<<", ">>"):
            return self.joined(node.op, a, self.converted(b, "word"), a.type)
        if a.literal is not None and b.literal is not None and node.op == "+":
            return self.integer(a.literal + b.literal)
        a, b, kind = self.common(a, b)
        return self.joined(node.op, self.settled(a), self.settled(b), kind)

    def of_ternaryop(self, node):
        then, other, _ = self.common(self.expression(node.iftrue), self.expression(node.iffalse))
        return self.choice(self.converted(self.expression(node.cond), "bool"), self.settled(then), self.settled(other))

    def of_cast(self, node):
        wanted = node.to_type.type.type.names[0].replace("blob_device_", "")
        return self.converted(self.settled(self.expression(node.expr)), wanted)

    def of_funccall(self, node):
        name, arguments = node.name.name, node.args.exprs
        if name == "sqrt":
            return Expression(f"sqrt({self.value(arguments[0], 'float')})", "float")
        if name == "blob_device_float":
            return Expression(f"bitcast<f32>({self.value(arguments[0], 'word')})", "float")
        function = self.query.functions[name]
        values = []
        for argument, parameter in zip(arguments, function.parameters):
            if isinstance(argument, c_ast.UnaryOp) and argument.op == "&":
                argument = argument.expr
            values.append(argument if parameter.kind == "out" else self.value(argument, parameter.type))
        texts = [v if isinstance(v, str) else self.address(v) for v in values]
        return Expression(f"{name}({', '.join(texts)})", function.result)

    @staticmethod
    def literal(number, kind, text=None):
        if kind == "float":
            text = text or str(number)
            return (text if "." in text or "e" in text else text + ".0") + "f"
        return (text or str(number)) + ("u" if kind in ("word", "words") else "")

    def variable(self, name):
        return f"(*{name})" if name in self.outputs else name

    @staticmethod
    def choice(condition, then, other):
        return Expression(f"select({other.text}, {then.text}, {condition.text})", then.type)

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

    def function(self, function):
        self.variables = {p.name: p.type for p in function.parameters}
        self.outputs = [p.name for p in function.parameters if p.kind == "out"]
        self.result = function.result
        self.counters = Names(function.body).counters
        self.temporaries, self.copies = 0, []
        parts = [f"{p.name}: " + (f"ptr<function, {self.type(p.type)}>" if p.kind == "out" else self.type(p.type))
                 for p in function.parameters]
        result = "" if function.result == "void" else f" -> {self.type(function.result)}"
        self.lines.append("")
        self.line(f"fn {function.name}({', '.join(parts)}){result} {{")
        for parameter in function.parameters:
            if parameter.kind == "in" and parameter.name in self.assigned(function.body):
                raise ValueError(f"{function.name} changes its parameter {parameter.name}")
        self.block(function.body)
        self.line("}")

    @staticmethod
    def assigned(body):
        """Names that an assignment changes; those that calls change are outputs."""
        names = set()

        class Assignments(c_ast.NodeVisitor):
            def visit_Assignment(self, node):
                if isinstance(node.lvalue, c_ast.ID):
                    names.add(node.lvalue.name)
                self.generic_visit(node)

        Assignments().visit(body)
        return names

    def statements(self, node):
        for item in (node.block_items if isinstance(node, c_ast.Compound) else [node]) or []:
            getattr(self, "do_" + type(item).__name__.lower(), self.do_other)(item)

    def block(self, node):
        self.depth += 1
        self.statements(node)
        self.depth -= 1

    def do_compound(self, node):
        self.statements(node)

    def do_other(self, node):
        raise ValueError(f"a statement that is not translated: {node}")

    def do_decl(self, node):
        kind, name = type_of(node.type), node.name
        self.variables[name] = kind
        if name in self.counters:
            return
        is_constant = "const" in node.quals or kind == "words"
        if node.init is None:
            self.declare(name, kind, None, False)
        elif isinstance(node.init, c_ast.TernaryOp) and kind in self.query.records:
            self.declare(name, kind, None, False)
            self.choose(c_ast.ID(name), node.init)
        else:
            self.declare(name, kind, self.value(node.init, kind), is_constant)

    def choose(self, target, node):
        """A choice between records, of which only one is computed."""
        self.do_if(c_ast.If(node.cond, c_ast.Assignment("=", target, node.iftrue),
                            c_ast.Assignment("=", target, node.iffalse)))

    def do_assignment(self, node):
        if isinstance(node.rvalue, c_ast.Assignment):  # a = b = c
            self.do_assignment(node.rvalue)
            innermost = node.rvalue
            while isinstance(innermost, c_ast.Assignment):
                innermost = innermost.rvalue
            self.do_assignment(c_ast.Assignment(node.op, node.lvalue, innermost))
            return
        target = node.lvalue
        if isinstance(target, c_ast.StructRef) and isinstance(target.name, c_ast.ID) \
                and self.variables[target.name.name] == BITS and target.field.name == "number":
            self.line(f"{self.variable(target.name.name)} = bitcast<u32>({self.value(node.rvalue, 'float')});")
            return
        place = self.expression(target)
        self.line(f"{place.text} {node.op} {self.value(node.rvalue, place.type)};")

    def do_unaryop(self, node):
        e = self.expression(node.expr)
        self.line(f"{e.text} {node.op[-1]}= {self.literal(1, e.type)};")

    def do_funccall(self, node):
        self.line(self.expression(node).text + ";")
        for text, copy in self.copies:
            self.line(f"{text} = {copy};")
        self.copies = []

    def do_return(self, node):
        self.line("return;" if node.expr is None else f"return {self.value(node.expr, self.result)};")

    def do_for(self, node):
        """A loop over elements of an array is written out: some implementations index values by constants alone."""
        counter, kind = node.init.lvalue.name, self.variables[node.init.lvalue.name]
        if node.cond.op != "<" or node.cond.left.name != counter or node.next.expr.name != counter:
            raise ValueError("a loop that does not count upwards by one")
        start, bound = self.value(node.init.rvalue, kind), node.cond.right
        if isinstance(bound, c_ast.Constant) and int(bound.value) <= MOST_WRITTEN_OUT:
            for value in range(int(start), int(bound.value)):
                self.known[counter] = value
                self.statements(node.stmt)
            del self.known[counter]
            return
        self.line(f"for (var {counter}: {self.type(kind)} = {start}; {counter} < {self.value(bound, kind)}; "
                  f"{counter} += {self.literal(1, kind)}) {{")
        self.block(node.stmt)
        self.line("}")

    def declare(self, name, kind, value, is_constant):
        word = "let" if is_constant else "var"
        self.line(f"{word} {name}: {self.type(kind)}" + ("" if value is None else f" = {value}") + ";")

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

    def do_break(self, _):
        self.line("break;")

    def do_continue(self, _):
        self.line("continue;")
