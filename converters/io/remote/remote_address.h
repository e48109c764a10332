// SPDX-License-Identifier: Apache-2.0
// Addresses of files elsewhere, as people write them in place of a file's name.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace lumen::convert {

enum class RemoteScheme : std::uint8_t { Http, Https, S3 };

struct RemoteAddress {
  RemoteScheme scheme = RemoteScheme::Https;
  std::string text;  ///< whole, as it is requested: its query may be a secret

  /// The address without its query: for messages, answers and records.
  [[nodiscard]] std::string shown() const;
  /// A name for the file: the last part of the path, without anything that could leave a folder.
  [[nodiscard]] std::string fileName() const;
  /// The address of a file below this one, which names a folder; the query stays at the end.
  [[nodiscard]] RemoteAddress below(std::string_view path) const;
};

/// Whether a text is meant as an address: it begins with http://, https:// or s3://.
bool isRemote(std::string_view text);

/// Throws Error(Usage) for an address without a host or a path, with a user or a password before
/// the host, or with characters that no address has. A fragment (#...) is left out.
RemoteAddress parseRemote(std::string_view text);

}  // namespace lumen::convert
