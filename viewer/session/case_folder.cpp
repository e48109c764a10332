// SPDX-License-Identifier: Apache-2.0
// library.h: the cases of a folder.
#include <algorithm>
#include <system_error>

#include "converters/library/index/library_file.h"
#include "formats/container/printable.h"
#include "viewer/session/library.h"

namespace lumen::viewer {

namespace {

namespace fs = std::filesystem;

bool isCase(const fs::directory_entry& entry) {
  const std::string name = entry.path().filename().string();
  std::error_code ignored;
  return !name.starts_with('.') && (name.ends_with(".lumen") || name.ends_with(".lumen.json")) &&
         name.find(".unsaved.") == name.npos && entry.is_regular_file(ignored);
}

std::string nameOfFolder(const fs::path& folder) {
  return formats::printable(
      fs::absolute(folder / "").lexically_normal().parent_path().filename().string());
}

CaseList publishedCases(const fs::path& folder) {
  const convert::LibraryFile library = convert::openLibrary(folder);
  CaseList list{formats::printable(library.title), {}, true};
  const fs::path beside = fs::absolute(folder / "").lexically_normal().parent_path().parent_path();
  for (const convert::LibraryEntry& entry : library.cases)
    list.cases.push_back({folder / convert::kPayload / entry.id / "case.lumen",
                          formats::printable(entry.title) + " (" + entry.id + ")",
                          beside / (entry.id + ".lumen")});
  return list;
}

}  // namespace

CaseList casesIn(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder / convert::kLibraryFile, error)) return publishedCases(folder);
  std::vector<fs::path> cases;
  const auto options = fs::directory_options::skip_permission_denied;
  fs::recursive_directory_iterator entry(folder, options, error);
  for (const fs::recursive_directory_iterator end; !error && entry != end; entry.increment(error)) {
    if (isCase(*entry)) cases.push_back(entry->path());
    if (entry.depth() > 0 || entry->path().filename().string().starts_with('.'))
      entry.disable_recursion_pending();
  }
  std::sort(cases.begin(), cases.end());
  CaseList list{nameOfFolder(folder), {}, false};
  for (const fs::path& file : cases)
    list.cases.push_back({file, formats::printable(file.lexically_relative(folder).string()), {}});
  return list;
}

}  // namespace lumen::viewer
