// SPDX-License-Identifier: Apache-2.0
#include "packages/python/src/blob_records.h"

namespace py = pybind11;

namespace lumen::python {

namespace {

constexpr py::ssize_t kDouble = sizeof(double);

bool isDouble(const py::array& points) {
  return points.dtype().num() == py::detail::npy_api::NPY_DOUBLE_ &&
         points.dtype().byteorder() == '=';
}

std::string shapeText(const py::array& points) {
  return py::str(points.attr("shape"));
}

}  // namespace

PackedPoints::PackedPoints(const py::object& points, const char* role) {
  const py::array given = py::array::ensure(points);
  if (!given) throw py::type_error(std::string(role) + ": found no array, expected (n, 3) or (3,)");
  m_isSingle = given.ndim() == 1 && given.shape(0) == 3;
  if (!m_isSingle && !(given.ndim() == 2 && given.shape(1) == 3))
    throw py::value_error(std::string(role) + ": found shape " + shapeText(given) +
                          ", expected (n, 3) or (3,)");
  m_count = m_isSingle ? 1 : static_cast<std::size_t>(given.shape(0));
  const bool isPacked = isDouble(given) && given.strides(given.ndim() - 1) == kDouble &&
                        (m_count < 2 || given.strides(0) == 3 * kDouble) &&
                        reinterpret_cast<std::uintptr_t>(given.data()) % alignof(double) == 0;
  if (isPacked) {
    m_kept = given;
    m_at = static_cast<const double*>(given.data());
  } else {
    copy(given, role);
  }
}

void PackedPoints::copy(const py::array& points, const char* role) {
  m_copy.resize(3 * m_count);
  m_at = m_copy.data();
  if (points.dtype().num() == py::detail::npy_api::NPY_FLOAT_ && points.itemsize() == 4 &&
      points.dtype().byteorder() == '=' && (points.flags() & py::array::c_style) != 0) {
    const auto* const single = static_cast<const float*>(points.data());
    for (std::size_t i = 0; i < m_copy.size(); ++i) m_copy[i] = static_cast<double>(single[i]);
    return;
  }
  const auto doubles =
      py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(points);
  if (!doubles)
    throw py::type_error(std::string(role) + ": found " + std::string(py::str(points.dtype())) +
                         ", expected numbers");
  std::copy_n(doubles.data(), m_copy.size(), m_copy.begin());
}

}  // namespace lumen::python
