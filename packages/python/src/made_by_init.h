// SPDX-License-Identifier: Apache-2.0
// Python can make an object by `__new__` alone. pybind11 hands on raw memory in its place, which no
// function here may use.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>

#include <pybind11/pybind11.h>

namespace lumen::python {

/// Base of the objects that Python makes. pybind11 gives an object whose `__init__` did not run
/// memory from this operator when a function takes it. The others are made by `::new`.
struct MadeByInit {
  static void* operator new(std::size_t) {
    throw pybind11::type_error("found an object whose __init__ did not run");
  }
  static void operator delete(void* at) { ::operator delete(at); }
};

/// Makes such an object.
template <class Object, class... Arguments>
std::unique_ptr<Object> makeObject(Arguments&&... arguments) {
  return std::unique_ptr<Object>(::new Object(std::forward<Arguments>(arguments)...));
}

/// Python makes no objects of this class itself.
template <class Type>
void forbidNew(const Type& type) {
  reinterpret_cast<PyTypeObject*>(type.ptr())->tp_new = [](PyTypeObject* made, PyObject*,
                                                           PyObject*) -> PyObject* {
    PyErr_Format(PyExc_TypeError, "%s: lumen alone makes objects of this class", made->tp_name);
    return nullptr;
  };
}

}  // namespace lumen::python
