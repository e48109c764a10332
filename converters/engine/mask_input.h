// SPDX-License-Identifier: Apache-2.0
// A volume of labels as an input: the labels that are vessels, and their names.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "converters/base/progress.h"
#include "converters/engine/file_format.h"
#include "converters/stages/trees_from_surfaces/label_mesh.h"

namespace lumen::engine {

struct VolumeArguments;

/// The user's statements about a volume of labels.
struct MaskArguments {
  bool isMask = false;                ///< every label but 0 is a vessel
  std::optional<std::int64_t> label;  ///< this one alone is
  std::string labels;                 ///< or "N=NAME,N=NAME"
  /// The volume holds labels.
  [[nodiscard]] bool isGiven() const { return isMask || label || !labels.empty(); }
  /// The labels chosen; empty: all. Throws Error(Usage) for a text that cannot be read.
  [[nodiscard]] convert::LabelNames names() const;
};

/// Tree and wall points of the labels in `volume`, which was read from `file`; as caseOfMaskFile().
formats::Case caseOfMask(const convert::Volume& volume, const std::filesystem::path& file,
                         const MaskArguments& arguments, Progress& progress);

/// Tree and wall points of the labels in `file`; a branch has the name of its label where there are
/// several, or names were given. Throws Error(InvalidInput) for a file without labels, and for
/// labels that are no vessels.
formats::Case caseOfMaskFile(const std::filesystem::path& file, const FileFormat& format,
                             const VolumeArguments& volume, const MaskArguments& arguments,
                             Progress& progress);

}  // namespace lumen::engine
