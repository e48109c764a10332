// SPDX-License-Identifier: Apache-2.0
// Volumes of labels as inputs: the labels that are vessels, and their names.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>

#include "converters/base/progress.h"
#include "converters/io/volume/label_table.h"
#include "converters/operations/source.h"

namespace lumen::engine {

/// The user's statements about a volume of labels.
struct MaskArguments {
  bool isMask = false;                ///< every label but 0 is a vessel
  std::optional<std::int64_t> label;  ///< this one alone is
  std::string labels;                 ///< or "N=NAME,N=NAME"
  InputFile labelTable;               ///< a file of names, or the name of a table; may be empty
  InputFile labelMap;                 ///< a volume of labels beside the input; may be empty
  /// The volume holds labels.
  [[nodiscard]] bool isGiven() const {
    return isMask || label || !labels.empty() || (!labelTable.empty() && labelMap.empty());
  }
  /// The labels that are vessels; empty: all. Throws Error(Usage) for a text that cannot be read.
  [[nodiscard]] std::set<std::int64_t> chosen() const;
  /// The names of --labels, or else of --label-table, or else those that `file`, the volume of
  /// labels, states itself; empty without all. Throws Error(Usage) and Error(InvalidInput).
  [[nodiscard]] convert::LabelNames names(const InputFile& file) const;
};

/// The volume of --label-map with the names of its labels; empty without one. Throws
/// Error(InvalidInput) for a file that is missing, or no volume.
std::optional<operations::LabelPart> loadRegions(const MaskArguments& arguments,
                                                 Progress& progress);

}  // namespace lumen::engine
