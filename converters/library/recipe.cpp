// SPDX-License-Identifier: Apache-2.0
// Declared in build_row.h.
#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/sha256.h"
#include "converters/base/text.h"
#include "converters/library/build_row.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace fs = std::filesystem;

namespace {

/// The digest of files under their names relative to `folder`.
std::string digestOfFiles(std::vector<fs::path> files, const fs::path& folder,
                          const Progress& progress) {
  std::sort(files.begin(), files.end());
  auto list = nlohmann::json::array();
  for (const fs::path& file : files) {
    progress.check();
    list.push_back({formats::printable(file.lexically_relative(folder).generic_string()),
                    digestOfFile(file).sha256});
  }
  return sha256(list.dump());
}

template <class Iterator>
std::vector<fs::path> listFiles(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (Iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (entry->is_regular_file(error)) files.push_back(entry->path());
  if (error) throw failed(formats::printable(folder.string()) + ": " + error.message());
  return files;
}

bool isHeader(const fs::path& file) {
  constexpr std::array<std::string_view, 5> kApart = {".nhdr", ".mhd", ".hdr", ".img", ".gltf"};
  return std::find(kApart.begin(), kApart.end(), lowerCase(file.extension().string())) !=
         kApart.end();
}

/// A header and the files that its voxels may be in.
std::vector<fs::path> filesOfHeader(const fs::path& header) {
  const std::string text = readWholeFile(header, "header");
  const bool isPattern = text.find('%') != std::string::npos;
  const fs::path folder = header.has_parent_path() ? header.parent_path() : fs::path(".");
  std::vector<fs::path> files = listFiles<fs::directory_iterator>(folder);
  std::erase_if(files, [&](const fs::path& file) {
    return !isPattern && file.stem() != header.stem() &&
           text.find(file.filename().string()) == std::string::npos;
  });
  return files;
}

}  // namespace

std::string digestOfInput(const fs::path& input, const Progress& progress) {
  std::error_code ignored;
  if (fs::is_directory(input, ignored))
    return digestOfFiles(listFiles<fs::recursive_directory_iterator>(input), input, progress);
  if (isHeader(input)) return digestOfFiles(filesOfHeader(input), input.parent_path(), progress);
  return digestOfFile(input).sha256;
}

Recipe makeRecipe(const BuildRow& row, const std::string& version, const std::string& shared,
                  const Progress& progress) {
  Recipe recipe;
  recipe.input = digestOfInput(row.input, progress);
  const nlohmann::json tree = {
      {"version", version},
      {"input", recipe.input},
      {"seeds", row.seeds.empty() ? "" : digestOfInput(row.seeds, progress)},
      {"options", row.options}};
  recipe.tree = sha256(tree.dump());
  const nlohmann::json all = {{"tree", recipe.tree},
                              {"id", row.id},
                              {"about", row.about},
                              {"targets", row.targets},
                              {"shared", shared}};
  recipe.all = sha256(all.dump());
  return recipe;
}

}  // namespace lumen::convert
