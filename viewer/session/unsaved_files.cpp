// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/unsaved_files.h"

#include <algorithm>
#include <system_error>

#include "converters/engine/file_access.h"
#include "converters/io/seeds/seeds.h"

namespace lumen::viewer {

namespace {

namespace fs = std::filesystem;

constexpr const char *kCase = ".lumen", *kSeeds = ".seeds.json";

/// "head.unsaved." of "head.lumen".
std::string stem(const fs::path& file) {
  std::string name = file.filename().string();
  name.erase(std::min(name.find('.', 1), name.size()));
  return name + ".unsaved";
}

void removeFile(fs::path& file) {
  std::error_code ignored;
  if (!file.empty()) fs::remove(file, ignored);
  file.clear();
}

}  // namespace

std::vector<fs::path> unsavedOf(const fs::path& file) {
  std::vector<fs::path> found;
  const fs::path folder = file.parent_path();
  std::error_code error;
  for (fs::directory_iterator entry(folder.empty() ? "." : folder, error), end;
       !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.starts_with(stem(file) + ".") && (name.ends_with(kCase) || name.ends_with(kSeeds)))
      found.push_back(folder / name);
  }
  std::sort(found.begin(), found.end());
  return found;
}

void UnsavedFiles::beside(const fs::path& file) {
  if (file == m_beside) return;
  *this = {};
  m_beside = file;
}

fs::path UnsavedFiles::freeName(const std::string& ending) const {
  fs::path file = m_beside.parent_path() / (stem(m_beside) + ending);
  std::error_code ignored;
  for (int i = 2; fs::exists(file, ignored); ++i)
    file = m_beside.parent_path() / (stem(m_beside) + "." + std::to_string(i) + ending);
  return file;
}

void UnsavedFiles::write(const std::shared_ptr<const formats::Case>& value,
                         const std::shared_ptr<const Seeds>& seeds) {
  if (!value) removeFile(m_caseFile);
  if (value && value != m_value) {
    if (m_caseFile.empty()) m_caseFile = freeName(kCase);
    app::writeCase(*value, m_caseFile, formats::CaseEncoding::Binary, {});
  }
  m_value = value;
  if (!seeds) removeFile(m_seedsFile);
  if (seeds && seeds != m_seeds) {
    if (m_seedsFile.empty()) m_seedsFile = freeName(kSeeds);
    convert::writeSeeds(*seeds, m_seedsFile);
  }
  m_seeds = seeds;
}

std::vector<fs::path> UnsavedFiles::files() const {
  std::vector<fs::path> list;
  for (const fs::path& file : {m_caseFile, m_seedsFile})
    if (!file.empty()) list.push_back(file);
  return list;
}

}  // namespace lumen::viewer
