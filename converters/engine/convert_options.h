// SPDX-License-Identifier: Apache-2.0
// The options that a case can be made and written with, as `lumen convert` and the C interface take
// them.
#pragma once

#include <optional>
#include <string>

#include "converters/base/options/option_table.h"
#include "converters/base/progress.h"
#include "converters/engine/file_format.h"
#include "converters/engine/source_input.h"
#include "converters/engine/stage_options.h"
#include "converters/operations/case_of.h"
#include "converters/operations/source.h"
#include "converters/stages/fitting/fit_options.h"

namespace lumen::engine {

struct ConvertOptions {
  SourceArguments source;
  TrackArguments track;
  InputFile corrected;  ///< a case whose corrections are made again; may be empty
  convert::FitOptions fit;
  OutputOptions output;

  /// Adds rows whose values are stored here, so this object outlives the table.
  void addRows(OptionTable& table);
  /// The options of caseOf(), but for models and for what files hold.
  [[nodiscard]] operations::CaseOptions caseOptions(FormatKind kind) const;
  /// Those of the models of this source. Refuses, as refuseUnused(), the scale of a cohesion that is
  /// 0, as it is for a case without voxels.
  [[nodiscard]] operations::ModelOptions modelOptions(const operations::Source& source,
                                                      const OptionTable& table,
                                                      Progress& progress) const;
  /// Takes the cells of a mesh in patches from a centerline, which has no voxel to take them from.
  void takeCellsOf(const operations::Source& source);
};

}  // namespace lumen::engine
