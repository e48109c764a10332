// SPDX-License-Identifier: Apache-2.0
// Answers of a device on a packed buffer, against blob_query_columns().
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "blob.h"

namespace lumen::blob::test {

/// Points about the nodes of a model, as floats, with cursors that know their vessel; a few of them
/// are no numbers, out of range or have no cursor.
struct Points {
  std::vector<float> xyz;
  std::vector<std::uint32_t> cursor;

  Points(const blob_model* model, std::size_t count);
  [[nodiscard]] std::size_t count() const { return cursor.size(); }
};

constexpr std::size_t kNumbers = 8;  ///< distance, normal, f, grad f

struct Answers {
  std::vector<std::uint32_t> cursor, state;
  std::vector<double> numbers;  ///< kNumbers of each point

  /// Takes a device's distances with normals, and f with grad f, four floats of each point.
  void setNumbers(const std::vector<float>& rows, const std::vector<float>& values);
};

/// A device that answers one batch again and again.
class OtherProcessor {
public:
  virtual ~OtherProcessor() = default;
  [[nodiscard]] virtual std::string name() const = 0;
  /// Uploads a batch, and moves its cursors.
  virtual void begin(const std::vector<std::uint32_t>& words, std::uint32_t flags,
                     const Points& points) = 0;
  /// Answers the batch; returns the seconds that it took.
  virtual double run() = 0;
  virtual Answers answers() = 0;
};

/// Processor time of all threads, s: other work on the machine does not count.
double processorSeconds();

/// A comparison: `--points N`, `--exact` and names of cases; without a case, synthetic trees of
/// each kernel, one of two vessels that touch.
struct Comparison {
  std::size_t points = 1'000'000;
  bool exact = false;
  std::vector<std::string> cases;
};

/// Prints how the answers agree, and both times. Returns 1 if they differ by more than
/// blob_device.h allows, else 0. Throws std::runtime_error for a case that cannot be read.
int compareWithLibrary(const Comparison& wanted, OtherProcessor& device);

}  // namespace lumen::blob::test
