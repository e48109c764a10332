// SPDX-License-Identifier: Apache-2.0
// A request that does not fit the changes since the page looked.
#pragma once

#include <string>

#include "converters/base/error.h"

namespace lumen::viewer {

/// The request was legal when the page made it. The server answers it with 409, a job ends with its
/// sentence.
class Conflict : public Error {
public:
  explicit Conflict(const std::string& sentence) : Error(ErrorKind::Usage, sentence) {}
};

}  // namespace lumen::viewer
