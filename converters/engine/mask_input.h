// SPDX-License-Identifier: Apache-2.0
// Volumes of labels as inputs: the labels that are vessels, and their names.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/io/labels/label_folder.h"
#include "converters/io/labels/label_meaning.h"
#include "converters/io/labels/settled_labels.h"
#include "converters/operations/source.h"

namespace lumen::engine {

/// The user's statements about a volume of labels.
struct MaskArguments {
  bool isMask = false;                ///< every label but 0 is a vessel
  std::optional<std::int64_t> label;  ///< this one alone is
  std::string labels;                 ///< or "N=NAME,N=NAME"
  InputFile labelTable;               ///< a file of names, or the name of a table; may be empty
  std::vector<InputFile> labelMaps;   ///< volumes of labels beside the input, or folders of them
  std::vector<std::string> roles;     ///< "NAME-OR-NUMBER=ROLE"
  bool isOnlyLabelled = false;        ///< without vessels on no label of the maps
  /// The volume holds labels.
  [[nodiscard]] bool isGiven() const {
    return isMask || label || !labels.empty() || (!labelTable.empty() && labelMaps.empty());
  }
  /// The labels that are vessels; empty: all. Throws Error(Usage) for a text that cannot be read.
  [[nodiscard]] std::set<std::int64_t> chosen() const;
  /// The table of --labels, or else of --label-table, or else the names that `file`, the volume of
  /// labels, states itself, or else those of a table beside it; without names otherwise. Details
  /// state a table that was found beside it, and one that cannot be read. `layer`: the one of several
  /// layers of segments that was read. Throws Error(Usage) and Error(InvalidInput).
  [[nodiscard]] convert::LabelTable table(const InputFile& file, Progress& progress,
                                          std::int64_t layer = 0) const;
};

/// The voxels of settled labels; what was settled becomes warnings.
convert::Volume takeSettled(convert::SettledLabels settled, const std::string& name,
                            Progress& progress);

/// Why a text is no NAME-OR-NUMBER=ROLE; empty if it is one.
std::string roleFault(const std::string& text);

/// A map with the meanings of its labels, those included that no table names.
operations::LabelPart labelPart(convert::Volume voxels, const std::string& name,
                                const convert::LabelTable& table);
/// Gives labels the roles of --role. Throws Error(Usage) for a label that none of the maps has.
void stateRoles(const std::vector<std::string>& statements,
                std::vector<operations::LabelPart>& maps);

/// A folder of structures as one map (io/labels/label_folder.h). Its remarks become warnings.
convert::FolderMap loadLabelFolder(const InputFile& folder,
                                   const convert::ReadVolumeOptions& options, Progress& progress);
/// Throws Error(Usage): --label-table names labels of files alone.
[[noreturn]] void refuseTableOfFolder();

/// The maps of --label-map, files or folders of structures. Throws as stateRoles(),
/// Error(InvalidInput) for a file that is missing, or no volume, and Error(Usage) for a table
/// beside folders alone.
/// `grid`: of the volume beside them, on which contours are filled; null: none.
std::vector<operations::LabelPart> loadLabelMaps(const MaskArguments& arguments,
                                                 const convert::VolumeGeometry* grid,
                                                 Progress& progress);

}  // namespace lumen::engine
