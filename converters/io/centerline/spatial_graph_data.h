// SPDX-License-Identifier: Apache-2.0
// The fields of Amira's files (AmiraMesh 2.0, 3.0; Avizo): a header in text, and numbers in text or binary.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace lumen::convert {

/// One field: `POINT { float thickness } @5`.
struct AmiraField {
  std::string location, name, type;
  std::size_t components = 1;
  int data = 0;                ///< number behind @
  std::string codec;           ///< HxByteRLE or HxZip; empty: none
  std::size_t codecBytes = 0;  ///< of packed data
  std::vector<double> values;  ///< of fields that were wanted, tuple after tuple
};

struct AmiraFile {
  std::string content;            ///< "HxSpatialGraph"
  std::string unit;               ///< of coordinates; empty: not stated
  std::vector<double> transform;  ///< 16 numbers, column after column; empty: not stated
  std::map<std::string, std::size_t> counts;  ///< by location: VERTEX, EDGE, POINT
  std::vector<AmiraField> fields;

  [[nodiscard]] const AmiraField* field(std::string_view location, std::string_view name) const;
};

/// A file with the values of all fields of VERTEX, EDGE and POINT. Memory is bounded by the size of the
/// text, and packed data by the expansion of their codec. Throws Error(InvalidInput) with `name`, the
/// line, the finding and the expectation, and Error(Unsupported) for other content than a spatial
/// graph.
AmiraFile parseAmira(std::string_view bytes, const std::string& name);

}  // namespace lumen::convert
