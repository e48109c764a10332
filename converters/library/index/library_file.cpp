// SPDX-License-Identifier: Apache-2.0
#include "converters/library/index/library_file.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <random>

#include <nlohmann/json.hpp>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/library/index/json_values.h"
#include "formats/container/printable.h"

namespace lumen::convert {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMostCases = 100000;

LibraryEntry readEntry(const JsonPlace& place) {
  place.onlyKeys({"id", "version", "title", "record", "files", "bytes"});
  const JsonPlace record = place.at("record");
  record.onlyKeys({"bytes", "sha256"});
  LibraryEntry entry;
  entry.id = caseId(place.at("id"));
  entry.version = static_cast<std::uint32_t>(wholeNumber(place.at("version"), 1, UINT32_MAX));
  entry.title = plainText(place.at("title"), 255, 1);
  entry.recordBytes = wholeNumber(record.at("bytes"));
  entry.recordSha256 = digest(record.at("sha256"));
  entry.files = wholeNumber(place.at("files"));
  entry.bytes = wholeNumber(place.at("bytes"));
  return entry;
}

Json originJson(const LibraryFile& library) {
  if (!library.origin) return {};
  return {{"id", library.origin->id},
          {"revision", library.origin->revision},
          {"sha256", library.origin->sha256}};
}

std::string uuid(const JsonPlace& place) {
  if (!isUuid(place.text())) place.refuse("a UUID in lower case");
  return place.text();
}

LibraryOrigin readOrigin(const JsonPlace& place) {
  place.onlyKeys({"id", "revision", "sha256"});
  return {uuid(place.at("id")), wholeNumber(place.at("revision"), 1), digest(place.at("sha256"))};
}

}  // namespace

std::string newLibraryId() {
  std::random_device source;
  std::array<unsigned, 8> parts{};
  for (unsigned& part : parts) part = source() & 0xFFFFU;
  parts[3] = (parts[3] & 0x0FFFU) | 0x4000U;
  parts[4] = (parts[4] & 0x3FFFU) | 0x8000U;
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "%04x%04x-%04x-%04x-%04x-%04x%04x%04x", parts[0],
                parts[1], parts[2], parts[3], parts[4], parts[5], parts[6], parts[7]);
  return text.data();
}

std::string libraryText(const LibraryFile& library) {
  Json json = {{"format", "lumen-library"},
               {"formatVersion", kLibraryFormat},
               {"id", library.id},
               {"revision", library.revision},
               {"previous", library.previous ? Json(*library.previous) : Json()},
               {"origin", originJson(library)},
               {"title", library.title},
               {"description", library.description},
               {"publisher", library.publisher},
               {"licence", library.licence},
               {"date", library.date},
               {"generator", library.generator}};
  if (!library.origin) json.erase("origin");
  // a line for each case, so that two revisions can be compared by eye
  std::string text = json.dump(2);
  text.resize(text.size() - 2);  // "\n}"
  text += ",\n  \"cases\": [";
  for (const LibraryEntry& entry : library.cases) {
    const Json line = {
        {"id", entry.id},
        {"version", entry.version},
        {"title", entry.title},
        {"record", Json{{"bytes", entry.recordBytes}, {"sha256", entry.recordSha256}}},
        {"files", entry.files},
        {"bytes", entry.bytes}};
    text += (&entry == library.cases.data() ? "\n    " : ",\n    ") + line.dump();
  }
  return text + (library.cases.empty() ? "]\n}\n" : "\n  ]\n}\n");
}

LibraryFile readLibrary(const std::string& text, const fs::path& file) {
  JsonFile document(text, file);
  const JsonPlace root(document);
  requireFormat(root, "lumen-library");
  root.onlyKeys({"format", "formatVersion", "id", "revision", "previous", "origin", "title",
                 "description", "publisher", "licence", "date", "generator", "cases"});
  LibraryFile library;
  library.id = uuid(root.at("id"));
  library.revision = wholeNumber(root.at("revision"), 1);
  if (!root.at("previous").value().isNull()) library.previous = digest(root.at("previous"));
  if (root.has("origin")) library.origin = readOrigin(root.at("origin"));
  library.title = plainText(root.at("title"), 255, 1);
  library.description = plainText(root.at("description"), 4096);
  library.publisher = plainText(root.at("publisher"), 255);
  library.licence = plainText(root.at("licence"), 255);
  library.date = day(root.at("date"));
  library.generator = plainText(root.at("generator"), 255);
  if (!library.generator.starts_with("lumen "))
    root.at("generator").refuse("\"lumen \" and a version");
  const auto cases = root.at("cases").elements();
  if (cases.size() > kMostCases)
    root.at("cases").refuse("at most " + std::to_string(kMostCases) + " cases");
  library.cases.reserve(cases.size());
  for (const JsonPlace& place : cases) library.cases.push_back(readEntry(place));
  return library;
}

LibraryFile openLibrary(const fs::path& folder) {
  const fs::path file = folder / kLibraryFile;
  std::error_code error;
  if (!fs::exists(folder, error))
    throw invalidInput(formats::printable(folder.string()) + ": there is no such library");
  if (!fs::is_regular_file(fs::symlink_status(file, error)))
    throw invalidInput(formats::printable(folder.string()) + ": found no " + kLibraryFile +
                       " in it, expected a library, which lumen library init makes");
  return readLibrary(readWholeFile(file, "list of cases"), file);
}

bool isOfOneRevision(std::string_view name) {
  return name == kMinisignSignatureFile || name == kOpenSshSignatureFile || name == kFirstPage ||
         name == kSiteFolder;
}

const LibraryEntry* findCase(const LibraryFile& library, const std::string& id) {
  const auto found = std::lower_bound(
      library.cases.begin(), library.cases.end(), id,
      [](const LibraryEntry& entry, const std::string& x) { return entry.id < x; });
  return found != library.cases.end() && found->id == id ? &*found : nullptr;
}

}  // namespace lumen::convert
