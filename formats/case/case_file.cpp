// SPDX-License-Identifier: Apache-2.0
#include "formats/case/case_file.h"

#include <cerrno>
#include <optional>

#include <sys/stat.h>

#include "formats/case/atomic_file.h"
#include "formats/case/file_descriptor.h"

namespace lumen::formats {
namespace {

namespace fs = std::filesystem;

Issue ioError(ErrorCode code, const fs::path& file, const std::string& what) {
  return {code, std::nullopt, file.string() + ": " + what};
}

std::string_view asText(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

bool startsLikeJson(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos &&
         (text[first] == '{' || text.starts_with("\xef\xbb\xbf"));
}

// Includes damaged signatures, whose faults the decoder reports.
bool startsLikeContainer(std::string_view text) {
  return text.starts_with("\x8c") || text.substr(0, 8).find("LUMEN") != std::string_view::npos;
}

std::optional<Case> decode(std::span<const std::byte> bytes, IssueList& issues) {
  const std::string_view text = asText(bytes);
  if (startsLikeContainer(text)) return decodeBinary(bytes, issues);
  if (startsLikeJson(text)) return decodeJson(text, issues);
  issues.add(
      {ErrorCode::NotLumen, 0, "neither the signature of .lumen nor the brace of .lumen.json"});
  return std::nullopt;
}

}  // namespace

Expected<std::vector<std::byte>> readFileBytes(const fs::path& file) {
  const FileDescriptor open = openForReading(file);
  const auto reason = [] { return systemErrorText(errno); };
  if (!open.isOpen())
    return ioError(errno == ENOENT || errno == ENOTDIR ? ErrorCode::IoMissing : ErrorCode::IoRead,
                   file, reason());
  struct stat info {};
  if (::fstat(open.get(), &info) != 0) return ioError(ErrorCode::IoRead, file, reason());
  if (!S_ISREG(info.st_mode))
    return ioError(ErrorCode::IoNotAFile, file,
                   S_ISDIR(info.st_mode) ? "is a directory, expected a .lumen or .lumen.json file"
                                         : "is not a regular file");
  std::vector<std::byte> bytes(static_cast<std::size_t>(info.st_size));
  const std::ptrdiff_t got = readInto(bytes, open.get());
  if (got < 0) return ioError(ErrorCode::IoRead, file, reason());
  bytes.resize(static_cast<std::size_t>(got));  // decoding finds a file that shrank meanwhile
  if (bytes.empty()) return ioError(ErrorCode::IoEmpty, file, "the file is empty");
  return bytes;
}

Expected<Case> decodeCase(std::span<const std::byte> bytes) {
  IssueList issues(1, IssueList::Keep::Errors);
  auto value = decode(bytes, issues);
  if (auto error = issues.firstError()) return *std::move(error);
  return *std::move(value);
}

Expected<Case> readCaseFile(const fs::path& file) {
  const auto bytes = readFileBytes(file);
  if (!bytes) return bytes.error();
  auto value = decodeCase(*bytes);
  if (value) return value;
  Issue error = value.error();
  error.message = file.string() + ": " + error.message;
  return error;
}

Expected<std::vector<std::byte>> encodeCase(const Case& value, CaseEncoding encoding,
                                            const EncodeOptions& options) {
  if (const auto valid = validate(value); !valid) {
    Issue error = valid.error();
    error.message = "the case is not valid and is not written: " + error.message;
    return error;
  }
  if (encoding == CaseEncoding::Binary) return encodeBinary(value, options);
  std::string text;
  if (options.pointBits == 0) {
    text = encodeJson(value);
  } else {
    Case rounded = value;
    quantisePoints(rounded, options.pointBits);
    text = encodeJson(rounded);
  }
  const auto bytes = std::as_bytes(std::span(text));
  return std::vector<std::byte>(bytes.begin(), bytes.end());
}

Status writeCaseFile(const Case& value, const fs::path& file, CaseEncoding encoding,
                     const EncodeOptions& options) {
  const auto bytes = encodeCase(value, encoding, options);
  if (!bytes) return bytes.error();
  return writeFileAtomically(*bytes, file);
}

Status writeCaseFile(const Case& value, const fs::path& file) {
  const bool json = file.extension() == ".json";
  return writeCaseFile(value, file, json ? CaseEncoding::Json : CaseEncoding::Binary);
}

ValidationReport validateBytes(std::span<const std::byte> bytes, std::size_t maxIssues) {
  IssueList issues(maxIssues);
  (void)decode(bytes, issues);
  const IssueCounts counts = issues.counts();
  return {issues.take(), counts};
}

}  // namespace lumen::formats
