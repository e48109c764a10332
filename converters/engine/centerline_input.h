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

/// --frame, which states the axes of a mesh or centerline: empty, lps or ras.
void addFrameRow(OptionTable& table, std::string& frame);

struct LoadedCenterline {
  convert::CenterlineFile file;  ///< in mm and LPS
  convert::ReadFrame frame;      ///< unit and axes that were taken
};

/// The centerline in `file`. Assumptions become warnings. Throws Error(InvalidInput).
LoadedCenterline loadCenterline(const InputFile& file, const FileFormat& format,
                                const VolumeArguments& volume, const std::string& frame,
                                Progress& progress);

/// The facts of `lumen info`.
std::string centerlineInfoText(const LoadedCenterline& centerline);
Json centerlineInfoJson(const LoadedCenterline& centerline);

}  // namespace lumen::engine
