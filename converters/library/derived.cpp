// SPDX-License-Identifier: Apache-2.0
#include "converters/library/derived.h"

#include <algorithm>
#include <vector>

#include "converters/library/crate.h"

namespace lumen::convert {

namespace {

std::string manifestLine(std::string_view digest, std::string_view path) {
  return std::string(digest) + "  " + std::string(path) + "\n";
}

/// The lines of a case, sorted by path.
std::string manifestLines(const CaseRecord& record, const LibraryEntry& entry,
                          std::string_view crate) {
  std::vector<std::pair<std::string, std::string>> lines = {{kRecordFile, entry.recordSha256},
                                                            {kCrateFile, sha256(crate)}};
  for (const RecordedFile& file : record.files) lines.emplace_back(file.path, file.sha256);
  std::sort(lines.begin(), lines.end());
  std::string text;
  for (const auto& [path, digest] : lines)
    text += manifestLine(digest, std::string(kPayload) + "/" + record.id + "/" + path);
  return text;
}

std::string bagInfo(const LibraryFile& library, std::uint64_t bytes, std::uint64_t files) {
  std::string text = "Bagging-Date: " + library.date + "\n" +
                     "Payload-Oxum: " + std::to_string(bytes) + "." + std::to_string(files) + "\n" +
                     "External-Identifier: urn:uuid:" + library.id + "\n" +
                     "External-Description: " + library.title + "\n";
  if (!library.publisher.empty()) text += "Source-Organization: " + library.publisher + "\n";
  return text + "Bag-Software-Agent: " + library.generator + "\n";
}

}  // namespace

void LibraryTexts::DigestedSink::add(std::string_view text) {
  sum.add(text);
  bytes += text.size();
  sink(text);
}

LibraryTexts::LibraryTexts(const LibraryFile& library, TextSink manifest, TextSink crate)
    : m_library(library), m_manifest(std::move(manifest)), m_crate(std::move(crate)) {
  CrateEntity root = libraryEntity(library);
  root["hasPart"] = CrateEntity::array();
  for (const LibraryEntry& entry : library.cases)
    root["hasPart"].push_back(reference(entry.id + "/"));
  m_crate.add(crateHead() + crateLine(root));
  if (!library.publisher.empty())
    m_crate.add(
        crateLine({{"@id", "#publisher"}, {"@type", "Organization"}, {"name", library.publisher}}));
  m_licences.insert(library.licence);
}

void LibraryTexts::add(const CaseRecord& record, std::string_view crate) {
  const LibraryEntry& entry = m_library.cases.at(m_next++);
  m_manifest.add(manifestLines(record, entry, crate));
  CrateEntity entity = caseEntity(record);
  entity.erase("about");  // its codes are in the crate of the case
  m_crate.add(crateLine(entity));
  m_licences.insert(record.about.licence);
  m_files += entry.files + 2;
  m_bytes += entry.bytes + entry.recordBytes + crate.size();
}

TagTexts LibraryTexts::finish() {
  for (const std::string& licence : m_licences) m_crate.add(crateLine(licenceEntity(licence)));
  m_crate.add(crateEnd());
  m_manifest.add(manifestLine(m_crate.sum.text(), std::string(kPayload) + "/" + kCrateFile));
  TagTexts texts;
  texts.bag = "BagIt-Version: 1.0\nTag-File-Character-Encoding: UTF-8\n";
  texts.bagInfo = bagInfo(m_library, m_bytes + m_crate.bytes, m_files + 1);
  texts.tagManifest = manifestLine(sha256(texts.bagInfo), kBagInfoFile) +
                      manifestLine(sha256(texts.bag), kBagFile) +
                      manifestLine(sha256(libraryText(m_library)), kLibraryFile) +
                      manifestLine(m_manifest.sum.text(), kManifestFile);
  return texts;
}

}  // namespace lumen::convert
