// SPDX-License-Identifier: Apache-2.0
// One HTTP request, which curl makes. Private to the sources of this folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "converters/base/error.h"
#include "converters/io/remote/http_answer.h"
#include "converters/io/remote/remote_file.h"

namespace lumen::convert {

struct HttpRequest {
  std::filesystem::path output;      ///< new file for the body
  std::optional<std::string> range;  ///< "0-99" or "100-"
  std::string version;               ///< the range is asked of this version only; empty: of any
  std::uint64_t mostBytes = 0;       ///< of the body
};

enum class HttpEnd : std::uint8_t {
  Whole,     ///< the body is as long as announced
  Cut,       ///< a part of it may be there; another try may bring more
  TooLarge,  ///< the body has more than the most bytes; a part of it may be there
};

struct HttpResult {
  HttpEnd end = HttpEnd::Cut;
  HttpAnswer answer;
  std::uint64_t bytes = 0;  ///< of the output
  std::string why;          ///< of a cut: a clause for people
};

/// Follows redirections within the web. Throws Error(InvalidInput) if the server refuses the file
/// or has none, Error(Failed) for a fault that no other try mends, such as an unknown host,
/// Error(Unsupported) without curl, each with the address, and Error(Cancelled).
HttpResult requestByCurl(const RemoteAddress& address, const HttpRequest& request,
                         const RemoteOptions& options, const Progress& progress);

/// `ADDRESS: what`, printable.
Error remoteError(ErrorKind kind, const RemoteAddress& address, const std::string& what);

}  // namespace lumen::convert
