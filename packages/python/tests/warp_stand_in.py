# SPDX-License-Identifier: Apache-2.0
"""The part of NVIDIA Warp that lumen.warp uses, as plain Python on NumPy, for tests where Warp is missing.

Functions are rewritten so that they compute as Warp does: literals are float32 and int32, arguments and assigned names are
copies, and an operation, an assignment to a field or a choice between two types raises TypeError."""
import ast
import inspect
import itertools
import operator
import sys
import textwrap
import types as python_types

import numpy as np

float32, int32, uint32 = np.float32, np.int32, np.uint32
OPERATORS = {"Add": operator.add, "Sub": operator.sub, "Mult": operator.mul, "Div": operator.truediv, "BitAnd": operator.and_,
             "BitOr": operator.or_, "LShift": operator.lshift, "RShift": operator.rshift, "Lt": operator.lt, "Gt": operator.gt,
             "LtE": operator.le, "GtE": operator.ge, "Eq": operator.eq, "NotEq": operator.ne}
options = {}
_thread = [int32(0)]


def same(a, b, what):
    if type(a) is not type(b):
        raise TypeError(f"{what}: {type(a).__name__} and {type(b).__name__}")


class Vector:
    """`size` numbers of one type."""

    def __init__(self, *values):
        self.values = [self.dtype(0)] * self.size if not values else [self.dtype(v) for v in values]

    def __getitem__(self, i):
        if not 0 <= i < self.size:
            raise IndexError(i)
        return self.values[i]

    def __setitem__(self, i, value):
        same(value, self[i], "element")
        self.values[i] = value

    def copy(self):
        return type(self)(*self.values)


def vector(length, dtype):
    return type(f"vector_{length}", (Vector,), {"size": length, "dtype": dtype})


vec3, vec4 = vector(3, float32), vector(4, float32)
types = python_types.SimpleNamespace(vector=vector)


def struct(described):
    """A class whose fields have the types of its annotations, and are zero at first."""
    fields = described.__annotations__

    class Record:
        def __init__(self):
            for name, kind in fields.items():
                object.__setattr__(self, name, kind(0) if issubclass(kind, np.generic) else kind())

        def __setattr__(self, name, value):
            same(value, getattr(self, name), name)
            object.__setattr__(self, name, copied(value))

        def copy(self):
            other = Record()
            for name in fields:
                setattr(other, name, getattr(self, name))
            return other

    return Record


def copied(value):
    return value.copy() if hasattr(value, "copy") and not isinstance(value, (np.generic, array)) else value


class array:
    """Numbers or vectors in NumPy's memory; without data, a type."""

    def __init__(self, data=None, dtype=None, device=None):
        self.dtype, self.device = dtype, device
        kind = float32 if dtype is vec3 else dtype
        self.data = None if data is None else np.array(data, kind)

    def __len__(self):
        return len(self.data)

    def __getitem__(self, i):
        return vec3(*self.data[i]) if self.dtype is vec3 else self.data[i]

    def __setitem__(self, i, value):
        same(value, self[i], "element of an array")
        self.data[i] = value.values if isinstance(value, Vector) else value

    def numpy(self):
        return self.data


def full(count, value, dtype, device=None):
    return array(np.full((count, 3) if dtype is vec3 else count, value), dtype, device)


def zeros(count, dtype, device=None):
    return full(count, 0, dtype, device)


def set_module_options(given):
    options.update(given)


def constant(value):
    return int32(value) if isinstance(value, int) else value


def where(condition, then, other):
    same(then, other, "where")
    return then if condition else other


def cast(value, dtype):
    return np.array(value).view(dtype)[()]


def sqrt(value):
    return np.sqrt(value)


def tid():
    return _thread[0]


def apply(name, a, b):
    same(a, b, name)
    result = OPERATORS[name](a, b)
    if not isinstance(result, (np.bool_, type(a))):
        raise TypeError(f"{name} of {type(a).__name__} gives {type(result).__name__}")
    return result


class Strict(ast.NodeTransformer):
    """Rewrites a function as the head of this file states."""

    def __init__(self):
        self.numbers = itertools.count()

    @staticmethod
    def call(name, *arguments):
        return ast.Call(ast.Attribute(ast.Name("wp", ast.Load()), name, ast.Load()), list(arguments), [])

    def visit_Constant(self, node):
        if type(node.value) in (int, float):
            return self.call("int32" if isinstance(node.value, int) else "float32", node)
        return node

    def visit_BinOp(self, node):
        return self.call("apply", ast.Constant(type(node.op).__name__), self.visit(node.left), self.visit(node.right))

    def visit_Compare(self, node):
        right, = node.comparators
        return self.call("apply", ast.Constant(type(node.ops[0]).__name__), self.visit(node.left), self.visit(right))

    def visit_AugAssign(self, node):
        read = ast.parse(ast.unparse(node.target), mode="eval").body
        return ast.Assign([self.visit(node.target)], self.visit(ast.BinOp(read, node.op, node.value)))

    def visit_Assign(self, node):
        value = self.visit(node.value)
        if isinstance(node.value, ast.Name):
            value = self.call("copied", value)
        return ast.Assign([self.visit(target) for target in node.targets], value)

    def visit_Call(self, node):
        # the number of a constructor's literal, such as wp.uint32(5), has the type that it makes
        if len(node.args) == 1 and isinstance(node.args[0], ast.Constant):
            return node
        return self.generic_visit(node)

    def visit_For(self, node):
        self.generic_visit(node)
        counter = ast.Assign([ast.Name(node.target.id, ast.Store())], self.call("int32", ast.Name(node.target.id, ast.Load())))
        node.body.insert(0, counter)
        return node


def func(function):
    tree = ast.parse(textwrap.dedent(inspect.getsource(function)))
    definition, = tree.body
    definition.decorator_list = []
    for argument in definition.args.args:
        argument.annotation = None
    definition.body = [Strict().visit(statement) for statement in definition.body]
    scope = {}
    names = sys.modules[function.__module__].__dict__
    exec(compile(ast.fix_missing_locations(tree), function.__code__.co_filename, "exec"), names, scope)  # pylint: disable=exec-used
    strict, kinds = scope[function.__name__], list(function.__annotations__.values())

    def called(*arguments):
        for value, kind in zip(arguments, kinds, strict=True):
            if not isinstance(value, array if isinstance(kind, array) else kind):
                raise TypeError(f"{function.__name__}: found {type(value).__name__}, expected {kind}")
        return strict(*(copied(value) for value in arguments))

    called.kinds = kinds
    return called


kernel = func


def launch(launched, dim, inputs, device=None):
    values = [value if isinstance(kind, array) or hasattr(value, "copy") else kind(value) for value, kind in zip(inputs, launched.kinds, strict=True)]
    with np.errstate(all="ignore"):
        for i in range(dim):
            _thread[0] = int32(i)
            launched(*values)
