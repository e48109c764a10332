// SPDX-License-Identifier: Apache-2.0
// Files elsewhere, brought to a folder of this machine. Installed programs make the requests: curl
// those of the web, rclone or aws those of object stores; a request goes to the address that the
// caller hands over, and to those of the web that its server redirects to.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "converters/base/progress.h"
#include "converters/io/remote/remote_address.h"

namespace lumen::convert {

struct RemoteOptions {
  unsigned stallSeconds = 30;  ///< a server that sends nothing for so long is given up
  unsigned pauseMs = 500;      ///< before another try, and twice as long before each further one
  int fruitlessTries = 4;      ///< tries in a row that brought nothing new end a transfer
  std::uint64_t mostBytes = std::uint64_t{1} << 40;  ///< of a file
};

struct RemoteFile {
  std::filesystem::path path;
  std::uint64_t bytes = 0;
  std::string sha256;
};

/// Brings a whole file into `folder`, which has none of its name, and goes on where a connection
/// was cut, if the server sends ranges of the same file. Throws Error(InvalidInput) for a file that
/// is not there, may not be read or is too large, Error(Unsupported) where no installed program can
/// fetch it, Error(Failed) where the transfer fails, each with the address, and Error(Cancelled).
RemoteFile fetchFile(const RemoteAddress& address, const std::filesystem::path& folder,
                     const RemoteOptions& options, Progress& progress);

/// The beginning of a file, and the size of the whole.
struct RemoteHead {
  std::string bytes;
  std::uint64_t whole = 0;
};

/// The first `count` bytes of a file, or all of a shorter one; `scratch` is a folder for temporary
/// files. Nothing if the server sends only whole files, or does not state their size: then no more
/// than `count` bytes of one have come. Throws as fetchFile().
std::optional<RemoteHead> fetchHead(const RemoteAddress& address, std::uint64_t count,
                                    const std::filesystem::path& scratch,
                                    const RemoteOptions& options, Progress& progress);

}  // namespace lumen::convert
