// SPDX-License-Identifier: Apache-2.0
// Arrays of NumPy that point into memory of lumen, whose owner they keep alive.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <pybind11/numpy.h>

namespace lumen::python {

template <class Element>
struct Row {
  using Number = Element;
  static constexpr pybind11::ssize_t columns = 1;
};
template <class Element, std::size_t size>
struct Row<std::array<Element, size>> {
  using Number = Element;
  static constexpr pybind11::ssize_t columns = size;
};

/// A view of the numbers of `data`, which `owner` holds: (rows,) or (rows, columns). `Shown`: a
/// type of the same size in place of their own.
template <class Shown, class Element>
pybind11::array viewAs(const pybind11::object& owner, const std::vector<Element>& data,
                       bool isWritable = true, pybind11::ssize_t columns = Row<Element>::columns) {
  static_assert(sizeof(Shown) == sizeof(typename Row<Element>::Number));
  constexpr auto kSize = static_cast<pybind11::ssize_t>(sizeof(Shown));
  const auto count = static_cast<pybind11::ssize_t>(data.size()) * Row<Element>::columns;
  std::vector<pybind11::ssize_t> shape{count / columns}, strides{kSize * columns};
  if (columns > 1) {
    shape.push_back(columns);
    strides.push_back(kSize);
  }
  // NumPy would take a null pointer for a request to allocate
  static const Shown nothing{};
  const void* const at = data.empty() ? static_cast<const void*>(&nothing) : data.data();
  pybind11::array view(pybind11::dtype::of<Shown>(), shape, strides, at, owner);
  if (!isWritable) view.attr("setflags")(pybind11::arg("write") = false);
  return view;
}

}  // namespace lumen::python
