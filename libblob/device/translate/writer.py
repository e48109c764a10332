# SPDX-License-Identifier: Apache-2.0
"""Walks the functions of the query, and writes them in a language whose parts a subclass states."""
from pycparser import c_ast

from c_query import BITS, RANK, Expression, Names, type_of

WIDTH = 100  # columns
COMPARISONS = ("==", "!=", "<", ">", "<=", ">=")


class Writer:
    """Text of all functions. A subclass states the language's words and statements."""

    def __init__(self, query):
        self.query, self.lines, self.depth = query, [], 0
        self.variables, self.outputs, self.counters = {}, [], set()
        self.known = {}  # the value of a counter whose loop is written out
        self.temporaries = 0

    # ------------------------------------------------------------ lines

    def line(self, text):
        """A line, which goes on in further lines after WIDTH columns."""
        indent = "  " * self.depth * self.indentation
        if len(indent + text) > WIDTH:
            text = self.bracketed(text)
        depth = 0
        while len(indent + text) > WIDTH:
            at = self.break_of(text, WIDTH - len(indent), depth)
            if at is None:
                break
            self.lines.append(indent + text[:at])
            depth += sum((letter in "([") - (letter in ")]") for letter in text[:at])
            text = text[at + 1:]
            indent = "  " * (self.depth + 2) * self.indentation
        self.lines.append(indent + text)

    @staticmethod
    def bracketed(text):
        """The text of a statement that may be cut."""
        return text

    def break_of(self, text, most, depth):
        """The last space of those within the fewest parentheses, in the second half of a line; none between name and type."""
        best, fewest = None, None
        for at, letter in enumerate(text[:most + 1]):
            depth += (letter in "([") - (letter in ")]")
            is_space = letter == " " and text[at - 1] != ":" and at > most // 2
            if is_space and depth >= self.breaks_at and (best is None or depth <= fewest):
                best, fewest = at, depth
        return best

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
        return Expression(self.conversion(e.text, wanted), wanted)

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
        """A literal that stands alone, as an expression of the language."""
        return Expression(self.literal(e.literal, "int"), "int") if e.literal is not None else e

    def joined(self, op, a, b, kind):
        """Two expressions about an operator, in the parentheses that all languages need."""
        rank = RANK[op]

        def inner(e, is_right):
            if rank >= RANK["+"]:
                is_bare = e.rank > rank or (e.rank == rank and not is_right)
            elif rank in (RANK["|"], RANK["<<"]):
                is_bare = e.rank > RANK["*"]
            else:  # a comparison stands bare within && and ||, but no && within ||
                is_bare = e.rank >= RANK["+"] or rank < e.rank == RANK["=="]
            return e.text if is_bare else f"({e.text})"

        return Expression(f"{inner(a, False)} {self.operators.get(op, op)} {inner(b, True)}", kind, rank)

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
            return word if node.field.name == "word" else Expression(self.reinterpreted(word.text, "float"), "float")
        e = self.expression(node.name)
        return Expression(f"{e.text}.{node.field.name}", self.query.records[e.type][node.field.name])

    def of_arrayref(self, node):
        e = self.expression(node.name)
        if e.type == "words":
            index = self.expression(node.subscript)
            place = e if index.literal == 0 else self.joined("+", e, self.converted(index, "word"), "words")
            return Expression(self.loaded(place.text), "word")
        index = self.settled(self.expression(node.subscript))
        return Expression(f"{e.text}[{index.text}]", e.type[1])

    def of_unaryop(self, node):
        e = self.expression(node.expr)
        if node.op == "*":
            return Expression(self.loaded(e.text), "word") if e.type == "words" else e
        if node.op == "!":
            if e.type == "int":
                return self.compared("==", e, self.integer(0))
            return Expression(f"{self.negation}({e.text})", "bool", 8)
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
        wanted = self.type_named(node)
        return self.converted(self.settled(self.expression(node.expr)), wanted)

    @staticmethod
    def type_named(node):
        return node.to_type.type.type.names[0].replace("blob_device_", "")

    def of_funccall(self, node):
        name, arguments = node.name.name, node.args.exprs
        if name == "sqrt":
            return Expression(f"{self.square_root}({self.value(arguments[0], 'float')})", "float")
        if name == "blob_device_float":
            return Expression(self.reinterpreted(self.value(arguments[0], "word"), "float"), "float")
        function = self.query.functions[name]
        values = []
        for argument, parameter in zip(arguments, function.parameters):
            if isinstance(argument, c_ast.UnaryOp) and argument.op == "&":
                argument = argument.expr
            values.append(argument if parameter.kind == "out" else self.value(argument, parameter.type))
        return Expression(self.call(function, values), function.result)

    # ------------------------------------------------------------ statements

    def function(self, function):
        self.variables = {p.name: p.type for p in function.parameters}
        self.outputs = [p.name for p in function.parameters if p.kind == "out"]
        self.result = function.result
        self.counters = Names(function.body, self.query.functions).counters
        self.temporaries = 0
        self.begin(function)
        for parameter in function.parameters:
            if parameter.kind == "in" and parameter.name in self.assigned(function.body):
                raise ValueError(f"{function.name} changes its parameter {parameter.name}")
        self.statements(function.body)
        self.end(function)

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
        raise ValueError(f"a statement that no language gets: {node}")

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
            self.assign(self.variable(target.name.name), "=", self.reinterpreted(self.value(node.rvalue, "float"), "word"))
            return
        place = self.expression(target)
        self.assign(place.text, node.op, self.value(node.rvalue, place.type))

    def do_unaryop(self, node):
        e = self.expression(node.expr)
        self.assign(e.text, {"++": "+=", "p++": "+=", "--": "-=", "p--": "-="}[node.op], self.literal(1, e.type))

    def do_funccall(self, node):
        self.alone(self.expression(node).text)

    def do_return(self, node):
        self.give(None if node.expr is None else self.value(node.expr, self.result))

    def do_for(self, node):
        counter, kind = node.init.lvalue.name, self.variables[node.init.lvalue.name]
        if node.cond.op != "<" or node.cond.left.name != counter or node.next.expr.name != counter:
            raise ValueError("a loop that does not count upwards by one")
        self.count(counter, kind, self.value(node.init.rvalue, kind), node.cond.right, node.stmt)

