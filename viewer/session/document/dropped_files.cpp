// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/document/dropped_files.h"

#include <algorithm>
#include <cctype>
#include <system_error>
#include <utility>

#include "converters/base/error.h"
#include "formats/container/printable.h"

namespace lumen::viewer {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestName = 100;  // bytes

}  // namespace

std::string harmlessName(const std::string& name) {
  std::string text;
  for (const char c : name.substr(name.size() - std::min(name.size(), kLongestName)))
    text += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' ? c : '_';
  if (text.empty() || text.front() == '.') text.insert(0, "file");
  return text;
}

DroppedFile::~DroppedFile() {
  std::error_code ignored;
  fs::remove_all(m_path.parent_path(), ignored);
}

std::shared_ptr<const DroppedFile> DroppedFiles::placeFor(const std::string& name) {
  const std::lock_guard lock(m_mutex);
  if (!m_folder) {
    auto folder = formats::PendingFolder::beside(fs::temp_directory_path() / "lumen-view",
                                                 formats::PendingFolder::Existing::Replace);
    if (!folder) throw failed("no place for dropped files: " + folder.error().message);
    m_folder = std::make_unique<formats::PendingFolder>(std::move(*folder));
    fs::permissions(m_folder->path(), fs::perms::owner_all);
  }
  const fs::path own = m_folder->path() / std::to_string(++m_last);
  fs::create_directory(own);
  return std::make_shared<const DroppedFile>(own / harmlessName(name));
}

std::string DroppedFiles::withoutFolder(std::string text) const {
  const std::lock_guard lock(m_mutex);
  if (!m_folder) return text;
  // each file lies in a numbered folder of this one
  const std::string folder = formats::printable(m_folder->path().string()) + "/";
  for (std::size_t at = 0; (at = text.find(folder, at)) != text.npos;) {
    const std::size_t slash = text.find('/', at + folder.size());
    text.erase(at, (slash == text.npos ? at + folder.size() : slash + 1) - at);
  }
  return text;
}

}  // namespace lumen::viewer
