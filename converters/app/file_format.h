// SPDX-License-Identifier: Apache-2.0
// Which formats the command line knows, and what a path or --from/--to names.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace lumen::app {

enum class FormatKind { Volume, Case, Mesh };

struct FileFormat {
  std::string_view name;  ///< as --from and --to take it
  FormatKind kind;
  std::vector<std::string_view> extensions;  ///< lower case, longest first; empty: a directory
  bool readable;
  bool writable;  ///< by `convert`, `track` or `fit`
};

const std::vector<FileFormat>& fileFormats();

/// The format that `override` names if it is not empty, otherwise that of the path's name. Throws
/// Error(Unsupported) if there is none that can be read (or written); the message lists those that
/// can.
const FileFormat& inputFormat(const std::filesystem::path& path, std::string_view override);
const FileFormat& outputFormat(const std::filesystem::path& path, std::string_view override);

/// Throws Error(InvalidInput) if `path` is missing; `what` names its role, such as "seeds file".
void requireInput(const std::filesystem::path& path, std::string_view what);

/// Throws Error(Failed) unless `path` can be created: its folder must exist and take new files, and
/// it must not itself be a folder. Leaves nothing behind.
void requireWritable(const std::filesystem::path& path);

}  // namespace lumen::app
