// SPDX-License-Identifier: Apache-2.0
#include "converters/app/file_access.h"

#include <cerrno>
#include <cstring>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <unistd.h>

#include "converters/common/error.h"
#include "converters/common/sha256.h"
#include "formats/case/atomic_file.h"

namespace lumen::app {

namespace fs = std::filesystem;

namespace {

/// The file's name first and once, whether or not the message begins with it.
std::string errorText(const fs::path& file, formats::Issue error) {
  const std::string prefix = file.string() + ": ";
  if (error.message.starts_with(prefix)) error.message.erase(0, prefix.size());
  return prefix + error.text();
}

/// The whole of a case file, and the case in it.
std::pair<std::vector<std::byte>, formats::Case> readBoth(const fs::path& file) {
  requireInput(file, "case file");
  auto bytes = formats::readFileBytes(file);
  if (!bytes) throw invalidInput(errorText(file, bytes.error()));
  auto value = formats::decodeCase(*bytes);
  if (!value) throw invalidInput(errorText(file, value.error()));
  return {std::move(*bytes), std::move(*value)};
}

}  // namespace

formats::Case readCase(const fs::path& file) {
  return readBoth(file).second;
}

formats::Case readParentCase(const fs::path& file) {
  auto [bytes, value] = readBoth(file);
  value.metadata.parentSha256 = sha256(bytes);
  formats::dropDependentChunks(value);
  return std::move(value);
}

void writeCase(const formats::Case& value, const fs::path& file, formats::CaseEncoding encoding,
               const formats::EncodeOptions& options) {
  const auto written = formats::writeCaseFile(value, file, encoding, options);
  if (!written) throw failed(errorText(file, written.error()));
}

void writeText(std::string_view text, const fs::path& file) {
  const auto written = formats::writeFileAtomically(std::as_bytes(std::span(text)), file);
  if (!written) throw failed(errorText(file, written.error()));
}

void requireInput(const fs::path& path, std::string_view what) {
  std::error_code error;
  if (fs::exists(path, error)) return;
  throw invalidInput(path.string() + ": there is no such " + std::string(what));
}

void requireWritable(const fs::path& path) {
  std::error_code ignored;
  if (path.filename().empty() || fs::is_directory(path, ignored))
    throw failed(path.string() + ": this is a folder, but the output must be a file");
  if (fs::exists(path, ignored)) {
    if (!fs::is_regular_file(path, ignored))
      throw failed(path.string() + ": this is not a regular file, but the output must be one");
    if (access(path.c_str(), W_OK) != 0)
      throw failed(path.string() + ": this file may not be overwritten: " + std::strerror(errno));
  }
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, ignored))
    throw failed(path.string() + ": the output's folder " + folder.string() + " does not exist");
  // permission bits do not tell (read-only mounts, privileged users), so a file is begun and dropped
  const auto begun = formats::PendingFile::beside(path);
  if (!begun) throw failed(errorText(path, begun.error()));
}

}  // namespace lumen::app
