// SPDX-License-Identifier: Apache-2.0
// lumen export: a case as the folder of files of one target.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "converters/export/shared/target.h"
#include "converters/export/targets/grid/grid.h"
#include "converters/export/targets/openfoam/openfoam.h"
#include "converters/export/targets/sofa/export_sofa.h"

namespace lumen::convert {

/// All options, with the defaults of `lumen export`; each target takes those of its row.
struct ExportOptions : CommonOptions {
  GridOptions grid;
  SofaOptions sofa;
  FoamOptions foam;
};

struct ExportTarget : TargetRow {
  /// Throws lumen::Error: InvalidInput, with the reason, for a case that the target cannot hold.
  using Writer = ExportResult (*)(const ExportInput& input, const ExportOptions& options);

  Writer write = nullptr;
};

const std::vector<ExportTarget>& exportTargets();

/// The whole folder: the target's files, README.md and lumen-export.json (spec/export.md). Throws
/// as the target, and Error(InvalidInput) for a case without the models or the vessel that the
/// target needs.
ExportResult exportCase(const ExportTarget& target, const formats::Case& source,
                        const ExportOptions& options, const OptionTexts& texts, Progress& progress);

}  // namespace lumen::convert
