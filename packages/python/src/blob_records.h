// SPDX-License-Identifier: Apache-2.0
// Points from arrays of NumPy, and answers of libblob as objects whose columns are views.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include <pybind11/numpy.h>

#include "blob.h"
#include "packages/python/src/made_by_init.h"

namespace lumen::python {

/// Points as libblob takes them, block by block. Packed doubles stay where they are, and are one
/// block; packed floats become doubles block by block, in the processor's first cache; others are
/// copied at once.
class PackedPoints {
public:
  static constexpr std::size_t kBlock = 256;  ///< points of a block of floats: 6 kB as doubles

  /// An array (n, 3) or (3,) of numbers. Raises ValueError, which names `role`, for other shapes.
  PackedPoints(const pybind11::object& points, const char* role);
  [[nodiscard]] std::size_t count() const { return m_count; }
  [[nodiscard]] bool isSingle() const { return m_isSingle; }  ///< the shape is (3,)
  /// Calls `use` with the first index, the number and the positions of each block.
  template <class Use>
  void forBlocks(const Use& use) const {
    if (m_floats == nullptr) return use(std::size_t{0}, m_count, rows(m_at));
    double block[3 * kBlock];
    for (std::size_t begin = 0; begin < m_count; begin += kBlock) {
      const std::size_t count = std::min(kBlock, m_count - begin);
      std::copy_n(m_floats + 3 * begin, 3 * count, block);
      use(begin, count, rows(block));
    }
  }
  [[nodiscard]] std::array<double, 3> point(std::size_t index) const {
    std::array<double, 3> found;
    if (m_floats == nullptr)
      std::copy_n(m_at + 3 * index, 3, found.begin());
    else
      std::copy_n(m_floats + 3 * index, 3, found.begin());
    return found;
  }

private:
  static const double (*rows(const double* at))[3] {
    return reinterpret_cast<const double(*)[3]>(at);
  }
  void copy(const pybind11::array& points, const char* role);

  pybind11::object m_kept;
  std::vector<double> m_copy;
  const double* m_at = nullptr;
  const float* m_floats = nullptr;  ///< null for doubles
  std::size_t m_count = 0;
  bool m_isSingle = false;
};

/// Memory of answers. The last large block that was freed is kept for the next answer: pages that
/// the system gives anew cost half as much as the queries.
class RecordMemory {
public:
  explicit RecordMemory(std::size_t bytes);
  ~RecordMemory();
  RecordMemory(const RecordMemory&) = delete;
  RecordMemory& operator=(const RecordMemory&) = delete;
  [[nodiscard]] void* at() const { return m_block.get(); }

private:
  std::unique_ptr<std::byte[]> m_block;
  std::size_t m_size;
};

/// Answers of one kind, one for each point.
template <class Record>
struct Records {
  Records(std::size_t size, bool single)
      : count(size),
        isSingle(single),
        memory(size * sizeof(Record)),
        at(static_cast<Record*>(memory.at())) {}
  std::size_t count;
  bool isSingle;  ///< columns have no leading axis
  RecordMemory memory;
  Record* at;
};

/// Tool points and their nodes, which queries move.
struct CursorObject : MadeByInit {
  explicit CursorObject(std::size_t count) : nodes(count, BLOB_NOWHERE) {}
  std::vector<std::uint32_t> nodes;
};

/// A view of one field of all records: (n,) or (n, 3), or one number or (3,) for a single point.
template <class Record, class Field>
pybind11::object columnOf(const pybind11::object& self, Field Record::*field) {
  namespace py = pybind11;
  using Number = std::remove_extent_t<Field>;
  const auto& records = self.cast<const Records<Record>&>();
  static const Record nothing{};
  const Record& first = records.count > 0 ? records.at[0] : nothing;
  if constexpr (!std::is_array_v<Field>)
    if (records.isSingle) return py::cast(first.*field);
  std::vector<py::ssize_t> shape, strides;
  if (!records.isSingle) {
    shape.push_back(static_cast<py::ssize_t>(records.count));
    strides.push_back(sizeof(Record));
  }
  if constexpr (std::is_array_v<Field>) {
    shape.push_back(std::extent_v<Field>);
    strides.push_back(sizeof(Number));
  }
  return py::array(py::dtype::of<Number>(), shape, strides, &(first.*field), self);
}

/// A new array of truth values of one field, `mask` of it: (n,), or one for a single point.
template <class Record, class Field>
pybind11::object truthOf(const Records<Record>& records, Field Record::*field, unsigned mask) {
  namespace py = pybind11;
  const auto isTrue = [&](const Record& record) {
    return (static_cast<unsigned>(record.*field) & mask) != 0;
  };
  if (records.isSingle) return py::bool_(isTrue(records.at[0]));
  py::array_t<bool> truth(static_cast<py::ssize_t>(records.count));
  bool* const out = truth.mutable_data();
  for (std::size_t i = 0; i < records.count; ++i) out[i] = isTrue(records.at[i]);
  return truth;
}

/// Adds the module's classes Model, Cursor, Answer, Nearest, Hits and Approaches.
void addBlob(pybind11::module_& module);
/// Adds guidewires: the class Wires.
void addWires(pybind11::module_& module);

}  // namespace lumen::python
