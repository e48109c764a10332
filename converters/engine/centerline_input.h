// SPDX-License-Identifier: Apache-2.0
// Centerlines of other programs on the command line: reading, the facts of one, and its case.
#pragma once

#include <filesystem>
#include <string>

#include "converters/engine/answers/answer_text.h"
#include "converters/engine/file_format.h"
#include "converters/engine/stage_options.h"
#include "converters/io/centerline/case_of_centerline.h"

namespace lumen::engine {

struct CenterlineArguments {
  std::string frame;  ///< empty, lps or ras
};

void addCenterlineRows(OptionTable& table, CenterlineArguments& centerline);

struct LoadedCenterline {
  convert::CenterlineFile file;  ///< in mm and LPS
  double unit = 1;               ///< mm: the unit of its lengths in the file
};

/// The centerline in `file`. Assumptions become warnings. Throws Error(InvalidInput).
LoadedCenterline loadCenterline(const InputFile& file, const FileFormat& format,
                                const VolumeArguments& volume,
                                const CenterlineArguments& centerline, Progress& progress);

/// The facts of `lumen info`.
std::string centerlineInfoText(const LoadedCenterline& centerline);
Json centerlineInfoJson(const LoadedCenterline& centerline);

}  // namespace lumen::engine
