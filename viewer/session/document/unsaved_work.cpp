// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/document/unsaved_work.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>
#include <utility>

#include "converters/base/error.h"
#include "converters/engine/file_access.h"
#include "converters/io/seeds/seeds.h"
#include "formats/container/printable.h"
#include "viewer/session/document/document_seeds.h"

namespace lumen::viewer {

namespace {

namespace fs = std::filesystem;

constexpr const char *kCase = ".lumen", *kSeeds = ".seeds.json", *kProposals = ".proposals.lumen";

// Endings of two parts; of any other name the last part is its ending.
constexpr std::array<std::string_view, 2> kDoubleEndings = {".lumen.json", ".nii.gz"};

/// "head.v1.unsaved" of "head.v1.lumen".
std::string stem(const fs::path& file) {
  const std::string name = file.filename().string();
  for (const std::string_view ending : kDoubleEndings)
    if (name.size() > ending.size() && name.ends_with(ending))
      return name.substr(0, name.size() - ending.size()) + ".unsaved";
  return file.stem().string() + ".unsaved";
}

/// A link counts by itself: one that leads nowhere is not free, as writing would follow it.
bool isFree(const fs::path& file) {
  std::error_code ignored;
  return !fs::exists(fs::symlink_status(file, ignored));
}

fs::path freeName(const fs::path& place, const std::string& ending) {
  const fs::path folder = place.parent_path();
  fs::path file = folder / (stem(place) + ending);
  for (int i = 2; !isFree(file); ++i)
    file = folder / (stem(place) + "." + std::to_string(i) + ending);
  return file;
}

/// Makes a folder of the user's own where there is none; a failure shows when a file is written.
void makeFolder(const fs::path& folder) {
  std::error_code error;
  if (folder.empty() || !fs::create_directories(folder, error)) return;
  fs::permissions(folder, fs::perms::owner_all, error);
}

void removeFile(fs::path& file) {
  std::error_code ignored;
  if (!file.empty()) fs::remove(file, ignored);
  file.clear();
}

}  // namespace

std::vector<fs::path> findUnsavedWork(const fs::path& file) {
  std::vector<fs::path> found;
  const fs::path folder = file.parent_path();
  const std::string begin = stem(file) + ".";
  std::error_code error;
  for (fs::directory_iterator entry(folder.empty() ? "." : folder, error), end;
       !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.starts_with(begin) && (name.ends_with(kCase) || name.ends_with(kSeeds)))
      found.push_back(folder / name);
  }
  std::sort(found.begin(), found.end());
  return found;
}

bool holdsProposals(const fs::path& file) {
  return file.filename().string().ends_with(kProposals);
}

void UnsavedWork::keepPart(Copy& copy, const Parts& parts, const char* ending,
                           const std::function<void(const fs::path&)>& write) {
  if (!parts.first) removeFile(copy.file);
  if (parts.first && parts != copy.parts) {
    if (copy.file.empty()) {
      makeFolder(m_place.parent_path());
      copy.file = freeName(m_place, ending);
    }
    write(copy.file);
  }
  copy.parts = parts;
}

std::vector<fs::path> UnsavedWork::keep(const fs::path& place, const Document& document,
                                        const UnsavedParts& parts) {
  const auto writeCase = [](const formats::Case& value, const fs::path& file) {
    engine::writeCase(value, file, formats::CaseEncoding::Binary, {});
  };
  const std::lock_guard lock(m_keepMutex);
  if (place != m_place) m_case = m_seeds = m_proposals = {};
  m_place = place;
  keepPart(m_case, {parts.hasCase ? document.value : nullptr, document.seeds}, kCase,
           [&](const fs::path& file) { writeCase(*caseWithSeeds(document), file); });
  keepPart(m_proposals, {parts.hasProposals ? document.proposals : nullptr, nullptr}, kProposals,
           [&](const fs::path& file) { writeCase(*document.proposals, file); });
  keepPart(m_seeds, {parts.hasSeeds ? document.seeds : nullptr, nullptr}, kSeeds,
           [&](const fs::path& file) { convert::writeSeeds(*document.seeds, file); });
  std::vector<fs::path> copies;
  for (const Copy* const copy : {&m_case, &m_seeds, &m_proposals})
    if (!copy->file.empty()) copies.push_back(copy->file);
  return copies;
}

std::vector<fs::path> UnsavedWork::find(const fs::path& place) {
  std::vector<fs::path> found = findUnsavedWork(place);
  const std::lock_guard lock(m_foundMutex);
  return m_found = std::move(found);
}

std::vector<fs::path> UnsavedWork::found() const {
  const std::lock_guard lock(m_foundMutex);
  return m_found;
}

void UnsavedWork::remove(const fs::path& file) {
  std::error_code error;
  fs::remove(file, error);
  if (error)
    throw failed(formats::printable(file.filename().string()) +
                 " cannot be removed: " + error.message());
  const std::lock_guard lock(m_foundMutex);
  std::erase(m_found, file);
}

}  // namespace lumen::viewer
