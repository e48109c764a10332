// SPDX-License-Identifier: Apache-2.0
#include "packages/python/src/blob_records.h"

#include <mutex>
#include <utility>

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

/// Smaller blocks come back warm from the C library.
constexpr std::size_t kLeastKept = std::size_t{16} << 20;  // bytes
/// Larger blocks are too much to hold without need.
constexpr std::size_t kMostKept = std::size_t{128} << 20;  // bytes

struct SpareBlock {
  std::mutex mutex;
  std::unique_ptr<std::byte[]> block;
  std::size_t size = 0;
};
SpareBlock& spareBlock() {
  // never destroyed: answers may outlive the end of the module
  static SpareBlock& spare = *new SpareBlock;
  return spare;
}

}  // namespace

RecordMemory::RecordMemory(std::size_t bytes) : m_size(bytes) {
  if (bytes >= kLeastKept) {
    SpareBlock& spare = spareBlock();
    const std::lock_guard lock(spare.mutex);
    if (spare.size >= bytes && spare.size / 2 <= bytes) {
      m_size = std::exchange(spare.size, 0);
      m_block = std::move(spare.block);
      return;
    }
  }
  m_block = std::make_unique_for_overwrite<std::byte[]>(bytes);
}

RecordMemory::~RecordMemory() {
  if (m_size < kLeastKept || m_size > kMostKept) return;
  SpareBlock& spare = spareBlock();
  const std::lock_guard lock(spare.mutex);
  spare.block = std::move(m_block);
  spare.size = m_size;
}

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
  const bool isFloat = points.dtype().num() == py::detail::npy_api::NPY_FLOAT_ &&
                       points.dtype().byteorder() == '=' &&
                       (points.flags() & py::array::c_style) != 0 &&
                       reinterpret_cast<std::uintptr_t>(points.data()) % alignof(float) == 0;
  if (isFloat) {
    m_kept = points;
    m_floats = static_cast<const float*>(points.data());
    return;
  }
  const auto doubles =
      py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(points);
  if (!doubles)
    throw py::type_error(std::string(role) + ": found " + std::string(py::str(points.dtype())) +
                         ", expected numbers");
  m_copy.assign(doubles.data(), doubles.data() + 3 * m_count);
  m_at = m_copy.data();
}

}  // namespace lumen::python
