// SPDX-License-Identifier: Apache-2.0
// A volume of labels as an input: the labels that are vessels, and their names.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "converters/base/progress.h"
#include "converters/stages/tracking/track_case.h"
#include "converters/stages/trees_from_surfaces/label_mesh.h"

namespace lumen::engine {

/// The user's statements about a volume of labels.
struct MaskArguments {
  bool isMask = false;                ///< every label but 0 is a vessel
  std::optional<std::int64_t> label;  ///< this one alone is
  std::string labels;                 ///< or "N=NAME,N=NAME"
  std::string labelTable;             ///< a file of names, or the name of a table; may be empty
  std::string labelMap;               ///< a volume of labels beside the input; may be empty
  /// The volume holds labels.
  [[nodiscard]] bool isGiven() const {
    return isMask || label || !labels.empty() || (!labelTable.empty() && labelMap.empty());
  }
  /// The labels chosen; empty: all. Throws Error(Usage) for a text that cannot be read.
  [[nodiscard]] convert::LabelNames names() const;
  /// The names of --label-table, or else those that `file`, the volume of labels, states itself;
  /// empty without both. Throws Error(InvalidInput).
  [[nodiscard]] convert::LabelNames table(const std::filesystem::path& file) const;
};

/// Tree and wall points of the labels in `volume`, which was read from `file`; a branch has the
/// name of its label where there are several, or names were given. Throws Error(InvalidInput) for a
/// volume without labels, and for labels that are no vessels.
formats::Case caseOfMask(const convert::Volume& volume, const std::filesystem::path& file,
                         const MaskArguments& arguments, Progress& progress);

/// Names the branches of a case that was tracked in `volume`, read from `file`, by --label-map, and
/// gives the remarks on `ends` the names that their branches have then. Warns if no branch lies on a
/// label. Throws Error(InvalidInput) for a map that is no volume of labels, or lies elsewhere.
void nameByLabelMap(const convert::Volume& volume, const std::string& file,
                    const MaskArguments& arguments, formats::Case& target,
                    std::vector<convert::TrackEnd>& ends, Progress& progress);

}  // namespace lumen::engine
