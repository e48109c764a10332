// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/remote_library.h"

#include <algorithm>
#include <string_view>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/library/change.h"

namespace lumen::engine {

namespace {

void requireStated(const FetchedFile& file, std::uint64_t bytes, const std::string& digest,
                   const char* statedBy) {
  if (file.bytes == bytes && file.sha256 == digest) return;
  throw invalidInput(file.path.string() + ": is not what " + statedBy + " states: found " +
                     std::to_string(file.bytes) + " bytes, SHA-256 " + file.sha256 + ", expected " +
                     std::to_string(bytes) + " bytes, SHA-256 " + digest);
}

std::string pathIn(const std::string& id, const char* name) {
  return std::string(convert::kPayload) + "/" + id + "/" + name;
}

}  // namespace

convert::RemoteAddress libraryAddress(const convert::RemoteAddress& address) {
  const std::string folder = address.shown(), query = address.text.substr(folder.size());
  for (const std::string_view name : {convert::kLibraryFile, "index.html"})
    if (folder.ends_with(std::string("/").append(name)))
      return {address.scheme, folder.substr(0, folder.size() - name.size()) + query};
  return address;
}

convert::LibraryFile fetchLibrary(const convert::RemoteAddress& library, RemoteInputs& remote) {
  const std::filesystem::path file = remote.fetch(library.below(convert::kLibraryFile)).path;
  return convert::readLibrary(readWholeFile(file, "list of cases", kMostText), file);
}

convert::CaseRecord fetchRecord(const convert::RemoteAddress& library,
                                const convert::LibraryEntry& entry, RemoteInputs& remote) {
  const FetchedFile file = remote.fetch(library.below(pathIn(entry.id, convert::kRecordFile)));
  requireStated(file, entry.recordBytes, entry.recordSha256, convert::kLibraryFile);
  convert::CaseRecord record =
      convert::readRecord(readWholeFile(file.path, "record", kMostText), file.path);
  if (record.id != entry.id)
    throw invalidInput(file.path.string() + ": found the id " + record.id + ", expected " +
                       entry.id);
  return record;
}

std::filesystem::path fetchLibraryCase(const convert::RemoteAddress& library, const std::string& id,
                                       RemoteInputs& remote) {
  const convert::LibraryFile list = fetchLibrary(library, remote);
  const convert::CaseRecord record = fetchRecord(library, convert::requireCase(list, id), remote);
  const auto stated =
      std::find_if(record.files.begin(), record.files.end(),
                   [](const convert::RecordedFile& one) { return one.path == convert::kCaseFile; });
  const FetchedFile file = remote.fetch(library.below(pathIn(id, convert::kCaseFile)));
  if (stated == record.files.end())
    throw invalidInput(file.path.string() + ": its record does not list it");
  requireStated(file, stated->bytes, stated->sha256, convert::kRecordFile);
  return file.path;
}

std::filesystem::path caseOfLibrary(const std::filesystem::path& library,
                                    const std::optional<convert::RemoteAddress>& address,
                                    const std::string& id, RemoteInputs& remote) {
  if (address) return fetchLibraryCase(libraryAddress(*address), id, remote);
  const convert::LibraryFile list = convert::openLibrary(library);
  return library / pathIn(convert::requireCase(list, id).id, convert::kCaseFile);
}

}  // namespace lumen::engine
