// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/replaced_case.h"

#include <algorithm>
#include <vector>

#include "converters/library/change.h"
#include "converters/library/library_file.h"

namespace lumen::engine {

namespace {

void addOnce(std::vector<std::string>& words, const std::string& word) {
  if (std::find(words.begin(), words.end(), word) == words.end()) words.push_back(word);
}

/// A file of the library comes along under its name unless the user gives another of this name.
void keepFile(const std::filesystem::path& file, std::vector<std::string>& files) {
  if (std::none_of(files.begin(), files.end(), [&](const std::string& given) {
        return std::filesystem::path(given).filename() == file.filename();
      }))
    files.push_back(file.string());
}

}  // namespace

std::optional<convert::CaseRecord> replacedVersion(const std::filesystem::path& library,
                                                   const std::string& id) {
  const convert::LibraryFile before = convert::openLibrary(library);
  const convert::LibraryEntry* const entry = convert::findCase(before, id);
  if (entry == nullptr) return {};
  return convert::openRecord(library, *entry);
}

void keepWishes(const convert::CaseRecord& before, const std::filesystem::path& library,
                bool keepsViews, bool keepsTurntable, CaseWishes& wishes) {
  const std::filesystem::path folder = library / convert::kPayload / before.id;
  const std::vector<std::string>& views = pictureViews();
  bool hasSurface = false;
  for (const convert::RecordedFile& file : before.files) {
    const std::string& path = file.path;
    const auto isPicture = [&](const std::string& view) {
      return path == "picture-" + view + ".png";
    };
    if (file.role == "export") addOnce(wishes.targets, file.target);
    hasSurface = hasSurface || file.role == "surface";
    wishes.report = wishes.report || path == "report.html";
    wishes.viewer = wishes.viewer || path == "view.html";
    if (keepsTurntable && path.starts_with("turntable/")) ++wishes.turntable;
    const auto view = std::find_if(views.begin(), views.end(), isPicture);
    if (keepsViews && view != views.end()) addOnce(wishes.views, *view);
    if (path.starts_with("files/")) keepFile(folder / path, wishes.files);
  }
  wishes.surface = wishes.surface && hasSurface;
}

}  // namespace lumen::engine
