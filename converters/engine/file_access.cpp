// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/file_access.h"

#include <cerrno>
#include <cstring>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <unistd.h>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/options/option_value.h"
#include "converters/base/sha256.h"
#include "formats/case/atomic_file.h"
#include "formats/case/file_descriptor.h"

namespace lumen::engine {

namespace fs = std::filesystem;

namespace {

/// The file's name first and once, whether or not the message begins with it.
std::string errorText(const fs::path& file, formats::Issue error) {
  const std::string prefix = file.string() + ": ";
  if (error.message.starts_with(prefix)) error.message.erase(0, prefix.size());
  // a fault with a byte or a pointer lies in the content: the file could be read
  if (error.offset || error.pointer) return prefix + error.text();
  const bool isLimit = error.message.ends_with(formats::systemErrorText(EFBIG));
  return prefix + error.message + (isLimit ? " (ulimit -f prints the shell's limit)" : "");
}

/// Files that somebody made or measured are not replaced by files of another kind.
bool isPrecious(convert::ContentKind kind) {
  return kind == convert::ContentKind::Volume || kind == convert::ContentKind::Seeds ||
         kind == convert::ContentKind::Case || kind == convert::ContentKind::Centerline;
}

}  // namespace

std::vector<std::byte> readCaseBytes(const InputFile& file) {
  if (file.isInMemory()) {
    const std::string text = file.read("case file", kAnySize);
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
  }
  requireInput(file.path(), "case file");
  auto bytes = formats::readFileBytes(file.path());
  if (!bytes) throw invalidInput(errorText(file.path(), bytes.error()));
  return std::move(*bytes);
}

std::pair<std::vector<std::byte>, formats::Case> readCaseAndBytes(const InputFile& file) {
  std::vector<std::byte> bytes = readCaseBytes(file);
  auto value = formats::decodeCase(bytes);
  if (value) return {std::move(bytes), std::move(*value)};
  const std::string other = convert::notA(convert::ContentKind::Case, file);
  if (value.error().code == formats::ErrorCode::NotLumen && !other.empty())
    throw invalidInput(file.path().string() + ": " + other);
  throw invalidInput(errorText(file.path(), value.error()));
}

formats::Case readCase(const InputFile& file) {
  return readCaseAndBytes(file).second;
}

formats::Case readParentCase(const InputFile& file) {
  auto [bytes, value] = readCaseAndBytes(file);
  value.metadata.parentSha256 = sha256(bytes);
  formats::dropDependentChunks(value);
  return std::move(value);
}

std::string encodeCase(const formats::Case& value, const fs::path& file,
                       formats::CaseEncoding encoding, const formats::EncodeOptions& options) {
  const auto bytes = formats::encodeCase(value, encoding, options);
  if (!bytes) throw failed(errorText(file, bytes.error()));
  return {reinterpret_cast<const char*>(bytes->data()), bytes->size()};
}

void writeCase(const formats::Case& value, const OutputFile& file, formats::CaseEncoding encoding,
               const formats::EncodeOptions& options) {
  writeText(encodeCase(value, file.path(), encoding, options), file);
}

void writeText(std::string_view text, const OutputFile& file) {
  if (std::string* const bytes = file.bytes()) return void(bytes->assign(text));
  const auto written = formats::writeFileAtomically(std::as_bytes(std::span(text)), file.path());
  if (!written) throw failed(errorText(file.path(), written.error()));
}

void requireInput(const InputFile& file, std::string_view what) {
  if (file.isInMemory()) return;
  const fs::path& path = file.path();
  if (isAddress(path.string())) throw invalidInput(std::string(what) + ": " + kAddressFault);
  std::error_code error;
  if (!fs::exists(path, error))
    throw invalidInput(path.string() + ": there is no such " + std::string(what));
  if (access(path.c_str(), R_OK) != 0)
    throw invalidInput(path.string() + ": this " + std::string(what) +
                       " may not be read: " + std::strerror(errno));
}

void requireOrder(const InputFile& input, const OutputFile& output) {
  if (output.bytes() != nullptr) return;
  const convert::FileContent content = convert::detectContent(output.path());
  const std::string swapped = "; are the two swapped?";
  std::error_code ignored;
  if (!input.isInMemory() && !fs::exists(input.path(), ignored) && isPrecious(content.kind))
    throw invalidInput(input.name() + ": there is no such input, and the output is there (" +
                       output.name() + ": " + content.sentence() + ")" + swapped);
  if (content.kind == convert::ContentKind::Volume || content.kind == convert::ContentKind::Seeds)
    throw Error(ErrorKind::Usage,
                output.name() + ": " + content.sentence() + ", but given as the output" + swapped);
}

void requireWritable(const OutputFile& output, convert::ContentKind written) {
  if (output.bytes() != nullptr) return;
  const fs::path& path = output.path();
  std::error_code ignored;
  const convert::FileContent content = convert::detectContent(path);
  if (isPrecious(content.kind) && content.kind != written)
    throw Error(ErrorKind::Usage, path.string() + ": " + content.sentence() +
                                      ", which would be lost; choose another name");
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
  // permission bits are not enough (read-only mounts, privileged users), so a file is begun and
  // dropped
  const auto begun = formats::PendingFile::beside(path);
  if (!begun) throw failed(errorText(path, begun.error()));
}

}  // namespace lumen::engine
