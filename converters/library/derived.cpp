// SPDX-License-Identifier: Apache-2.0
#include "converters/library/derived.h"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "converters/base/sha256.h"
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

struct LibraryTexts::State {
  /// Hands a text on, and keeps its digest and size.
  class DigestedSink {
  public:
    explicit DigestedSink(TextSink sink) : m_sink(std::move(sink)) {}
    void add(std::string_view text) {
      m_sum.add(text);
      m_bytes += text.size();
      m_sink(text);
    }
    std::string digest() { return m_sum.text(); }
    [[nodiscard]] std::uint64_t bytes() const { return m_bytes; }

  private:
    TextSink m_sink;
    Sha256 m_sum;
    std::uint64_t m_bytes = 0;
  };

  State(const LibraryFile& given, TextSink manifestSink, TextSink crateSink)
      : library(given), manifest(std::move(manifestSink)), crate(std::move(crateSink)) {}
  const LibraryFile& library;
  DigestedSink manifest, crate;
  std::set<std::string> licences;
  std::size_t next = 0;
  std::uint64_t bytes = 0, files = 0;
};

LibraryTexts::LibraryTexts(const LibraryFile& library, TextSink manifest, TextSink crate)
    : m_state(std::make_unique<State>(library, std::move(manifest), std::move(crate))) {
  CrateEntity root = libraryEntity(library);
  root["hasPart"] = CrateEntity::array();
  for (const LibraryEntry& entry : library.cases)
    root["hasPart"].push_back(reference(entry.id + "/"));
  m_state->crate.add(crateHead() + crateLine(root));
  if (!library.publisher.empty())
    m_state->crate.add(
        crateLine({{"@id", "#publisher"}, {"@type", "Organization"}, {"name", library.publisher}}));
  m_state->licences.insert(library.licence);
}

LibraryTexts::~LibraryTexts() = default;

void LibraryTexts::add(const CaseRecord& record, std::string_view crate) {
  State& state = *m_state;
  const LibraryEntry& entry = state.library.cases.at(state.next++);
  state.manifest.add(manifestLines(record, entry, crate));
  CrateEntity entity = caseEntity(record);
  entity.erase("about");  // its codes are in the crate of the case
  state.crate.add(crateLine(entity));
  state.licences.insert(record.about.licence);
  state.files += entry.files + 2;
  state.bytes += entry.bytes + entry.recordBytes + crate.size();
}

void LibraryTexts::skip() {
  ++m_state->next;
}

TagTexts LibraryTexts::finish() {
  State& state = *m_state;
  for (const std::string& licence : state.licences)
    state.crate.add(crateLine(licenceEntity(licence)));
  state.crate.add(crateEnd());
  state.manifest.add(manifestLine(state.crate.digest(), std::string(kPayload) + "/" + kCrateFile));
  TagTexts texts;
  texts.bag = "BagIt-Version: 1.0\nTag-File-Character-Encoding: UTF-8\n";
  texts.bagInfo = bagInfo(state.library, state.bytes + state.crate.bytes(), state.files + 1);
  texts.tagManifest = manifestLine(sha256(texts.bagInfo), kBagInfoFile) +
                      manifestLine(sha256(texts.bag), kBagFile) +
                      manifestLine(sha256(libraryText(state.library)), kLibraryFile) +
                      manifestLine(state.manifest.digest(), kManifestFile);
  return texts;
}

}  // namespace lumen::convert
