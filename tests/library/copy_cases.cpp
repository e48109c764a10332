// SPDX-License-Identifier: Apache-2.0
// copy_cases LIBRARY COPIES N: a library with N copies of the first case of another, under ids of numbers, with all
// digests right: for measuring what grows with the number of cases.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "converters/base/sha256.h"
#include "converters/library/index/change.h"
#include "converters/library/index/derived.h"

namespace {

namespace fs = std::filesystem;
using namespace lumen;
using namespace lumen::convert;

void write(const fs::path& file, std::string_view text) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw failed(file.string() + ": cannot be written");
}

std::string idOf(std::size_t number) {
  std::string digits = std::to_string(number);
  return "copy-" + std::string(6 - std::min<std::size_t>(6, digits.size()), '0') + digits;
}

void copyCases(const fs::path& from, const fs::path& to, std::size_t count) {
  LibraryFile library = openLibrary(from);
  const LibraryEntry first = library.cases.at(0);
  CaseRecord record = openRecord(from, first);
  const fs::path source = from / kPayload / first.id;
  library.cases.clear();
  const auto rename = [&](std::size_t i) {
    record.id = idOf(i);
    record.about.title = "Copy " + std::to_string(i);
  };
  for (std::size_t i = 0; i < count; ++i) {
    rename(i);
    const fs::path folder = to / kPayload / record.id;
    fs::create_directories(folder);
    const std::string text = recordText(record);
    write(folder / kRecordFile, text);
    write(folder / kCrateFile, caseCrate(record));
    for (const RecordedFile& file : record.files) {
      fs::create_directories((folder / file.path).parent_path());
      fs::copy_file(source / file.path, folder / file.path);
    }
    library.cases.push_back({record.id, record.version, record.about.title, text.size(),
                             sha256(std::string_view(text)), first.files, first.bytes});
  }
  LibraryTexts texts(library);
  for (std::size_t i = 0; i < count; ++i) {
    rename(i);
    texts.add(library.cases[i], record, caseCrate(record));
  }
  const RevisionTexts tags = texts.finish();
  write(to / kManifestFile, tags.manifest);
  write(to / kRootCrate, tags.crate);
  write(to / kBagFile, tags.bag);
  write(to / kBagInfoFile, tags.bagInfo);
  write(to / kTagManifestFile, tags.tagManifest);
  write(to / kLibraryFile, libraryText(library));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fputs("usage: copy_cases LIBRARY COPIES N\n", stderr);
    return 2;
  }
  try {
    copyCases(argv[1], argv[2], std::strtoul(argv[3], nullptr, 10));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "copy_cases: %s\n", error.what());
    return 1;
  }
}
