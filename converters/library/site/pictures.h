// SPDX-License-Identifier: Apache-2.0
// Pictures of a case on its pages.
#pragma once

#include <string>
#include <vector>

#include "converters/library/record.h"

namespace lumen::convert {

struct CasePictures {
  std::string first;                ///< path in the folder of the case; empty without pictures
  std::string thumbnail;            ///< thumbnail.png, or the first
  std::vector<std::string> frames;  ///< pictures of a turntable, in order; empty without one
  std::vector<std::string> others;  ///< all that are neither
};

/// Pictures from files of the role picture that a browser draws (PNG, JPEG, WebP). The first is
/// picture.png, or by path the first that is no frame. A turntable is three or more files that
/// differ in three digits at the end, as `lumen picture --turntable` and `lumen library add
/// --turntable` name them.
CasePictures casePictures(const CaseRecord& record);

}  // namespace lumen::convert
