// SPDX-License-Identifier: Apache-2.0
// The head of an HTTP answer, as curl writes it down.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace lumen::convert {

/// `Content-Range: bytes FIRST-LAST/WHOLE`.
struct ContentRange {
  std::uint64_t first = 0, last = 0;
  std::optional<std::uint64_t> whole;  ///< none: the server does not know it
};

struct HttpAnswer {
  int status = 0;                       ///< 0: no answer came
  std::optional<std::uint64_t> length;  ///< bytes that this answer announces
  std::optional<ContentRange> range;    ///< none is there, or one that makes no sense
  /// Mark by which a later answer is about the same version of the file: a strong entity tag, or
  /// else the time of the last change; empty if neither is there.
  std::string version;
};

/// The last answer in `text`, which holds the heads of all answers on the way through redirections.
HttpAnswer parseHttpAnswer(std::string_view text);

}  // namespace lumen::convert
