// SPDX-License-Identifier: Apache-2.0
#include "converters/library/incoming_case.h"

#include <map>
#include <system_error>
#include <utility>

#include "converters/base/files.h"
#include "converters/base/sha256.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/library/revision_files.h"

namespace lumen::convert {

namespace {

namespace fs = std::filesystem;

}  // namespace

IncomingCase::IncomingCase(const fs::path& library)
    : m_workspace(pendingFolder(library, formats::PendingFolder::Existing::Replace)) {
  fs::create_directory(folder());
}

fs::path IncomingCase::newPath(const std::string& path) const {
  if (!isRecordedPath(path))
    throw PathError(quotedText(path) +
                    ": a library cannot have a file of this name; expected parts of " + kPathRule +
                    ", 255 bytes in all");
  for (const RecordedFile& file : record.files)
    if (lowerCase(file.path) == lowerCase(path))
      throw PathError(quotedText(path) + ": there are two files of this name");
  const fs::path place = folder() / path;
  fs::create_directories(place.parent_path());
  return place;
}

void IncomingCase::note(const std::string& path, const std::string& role,
                        const std::string& target) {
  const FileDigest digest = digestOfFile(folder() / path);
  record.files.push_back({path, role, target, mediaType(path), digest.bytes, digest.sha256});
}

void IncomingCase::add(const std::string& path, const std::string& role, std::string_view bytes,
                       const std::string& target) {
  const fs::path place = newPath(path);
  writeNewFile(bytes, place);
  note(path, role, target);
}

void IncomingCase::addProgram(const std::string& path, const std::string& role,
                              std::string_view bytes, const std::string& target) {
  add(path, role, bytes, target);
  allowRunning(folder() / path);
}

void IncomingCase::addFile(const std::string& path, const std::string& role,
                           const fs::path& source) {
  const fs::path place = newPath(path);
  std::error_code error;
  fs::copy_file(source, place, error);
  if (error)
    throw failed(formats::printable(source.string()) + ": cannot be copied: " + error.message());
  fs::permissions(place, fs::perms::owner_write | fs::perms::owner_read, fs::perm_options::add,
                  error);
  note(path, role, "");
}

std::string mediaType(const std::string& path) {
  static const std::map<std::string, const char*> kTypes = {
      {"csv", "text/csv"},        {"glb", "model/gltf-binary"}, {"gltf", "model/gltf+json"},
      {"html", "text/html"},      {"jpg", "image/jpeg"},        {"json", "application/json"},
      {"md", "text/markdown"},    {"obj", "model/obj"},         {"pdf", "application/pdf"},
      {"png", "image/png"},       {"py", "text/x-python"},      {"stl", "model/stl"},
      {"svg", "image/svg+xml"},   {"txt", "text/plain"},        {"usda", "model/vnd.usda"},
      {"xml", "application/xml"}, {"zip", "application/zip"},   {"3mf", "model/3mf"}};
  const std::size_t dot = path.find_last_of("./");
  if (dot == std::string::npos || path[dot] == '/') return "application/octet-stream";
  const auto found = kTypes.find(lowerCase(path.substr(dot + 1)));
  return found == kTypes.end() ? "application/octet-stream" : found->second;
}

}  // namespace lumen::convert
