// SPDX-License-Identifier: Apache-2.0
// What a case has that the format it is written to cannot hold.
#pragma once

#include <string>
#include <vector>

#include "converters/app/file_format.h"
#include "converters/common/progress.h"
#include "formats/case/case.h"

namespace lumen::app {

/// One phrase for each part of the case that is lost, such as "3 links"; empty if nothing is.
std::vector<std::string> lossesOf(const formats::Case& value, const FileFormat& format);

/// Warns of what `file` will not have.
void reportLosses(const formats::Case& value, const FileFormat& format, const std::string& file,
                  Progress& progress);

}  // namespace lumen::app
