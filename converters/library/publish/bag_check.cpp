// SPDX-License-Identifier: Apache-2.0
#include "converters/library/publish/bag_check.h"

#include <algorithm>

#include "converters/base/sha256.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"

namespace lumen::convert {

namespace {

// Bytes by which a file may be longer than its text and still be compared: the lines of cases whose
// records are missing, or of somebody's mistake.
constexpr std::uint64_t kMostMore = 64U << 20U;

/// Lines of a text, without those that are passed over.
class LineReader {
public:
  LineReader(std::string_view text, const std::set<std::string>& passedOver)
      : m_text(text), m_passedOver(passedOver) {}

  /// The next line; nothing at the end.
  std::optional<std::string> next() {
    while (!m_text.empty()) {
      const std::size_t end = std::min(m_text.find('\n'), m_text.size());
      std::string line(m_text.substr(0, end));
      if (end == m_text.size()) line += " (and no line end)";
      m_text.remove_prefix(std::min(end + 1, m_text.size()));
      ++m_number;
      if (!isPassedOver(line)) return line;
    }
    return {};
  }
  /// The number of the line that next() returned; past the last at the end.
  [[nodiscard]] std::size_t number() const { return m_number; }

private:
  /// A line of a manifest is a digest, two spaces and a path, data/ID/... or of the payload itself.
  [[nodiscard]] bool isPassedOver(const std::string& line) const {
    const std::size_t path = line.find("  ");
    if (m_passedOver.empty() || path == std::string::npos) return false;
    const std::size_t folder = line.find('/', std::min(line.find('/', path), line.size() - 1) + 1);
    return m_passedOver.contains(line.substr(path + 2)) ||
           (folder != std::string::npos &&
            m_passedOver.contains(line.substr(path + 2, folder - path - 1)));
  }

  std::string_view m_text;
  const std::set<std::string>& m_passedOver;
  std::size_t m_number = 0;
};

}  // namespace

std::optional<std::pair<std::string, std::string>> firstDifference(
    std::string_view found, std::string_view expected, const std::set<std::string>& passedOver) {
  LineReader lines(found, passedOver), others(expected, passedOver);
  while (true) {
    const auto line = lines.next(), other = others.next();
    if (!line && !other) return {};
    if (!line)
      return std::pair("nothing from line " + std::to_string(lines.number() + 1) + " on",
                       quotedText(*other));
    const std::string number = "line " + std::to_string(lines.number()) + " ";
    if (!other) return std::pair(number + quotedText(*line), std::string("no more lines"));
    if (*line == *other) continue;
    // long lines begin alike: shown from a little before the place
    const auto [a, b] = std::mismatch(line->begin(), line->end(), other->begin(), other->end());
    const auto same = static_cast<std::size_t>(a - line->begin());
    const std::size_t from = same > 40 && other->size() > 80 ? same - 20 : 0;
    return std::pair(number + quotedText(line->substr(from)), quotedText(other->substr(from)));
  }
}

void BagCheck::add(const LibraryEntry& entry, const CaseCheck& check) {
  if (check.record) return m_texts.add(entry, *check.record, check.crate);
  m_unknown.insert({kRootCrate, std::string(kPayload) + "/" + entry.id + "/"});
}

void BagCheck::compare(const std::string& path, const std::string& expected,
                       FaultList& faults) const {
  const FaultCode code = path == kRootCrate ? FaultCode::Crate : FaultCode::Bag;
  const PlainRead read = m_folder.read(path, {{}, true, expected.size() + kMostMore}, m_progress);
  if (read.fault != PlainFault::None) return faults.add({code, "", path, read.found, "a file"});
  if (path != kManifestFile && !m_unknown.empty()) return;
  if (!read.isRead)
    return faults.add(
        {code, "", path, counted(read.bytes, "byte", "bytes"), std::to_string(expected.size())});
  if (const auto other = firstDifference(read.content, expected, m_unknown))
    faults.add({code, "", path, other->first, other->second});
}

void BagCheck::finish(FaultList& faults) {
  RevisionTexts texts = m_texts.finish();
  // library.json may be written in another way of equal content
  const std::string written = sha256(libraryText(m_library));
  if (const std::size_t at = texts.tagManifest.find(written); at != std::string::npos)
    texts.tagManifest.replace(at, written.size(), sha256(m_text));
  compare(kBagFile, texts.bag, faults);
  compare(kBagInfoFile, texts.bagInfo, faults);
  compare(kTagManifestFile, texts.tagManifest, faults);
  compare(kManifestFile, texts.manifest, faults);
  compare(kRootCrate, texts.crate, faults);
}

}  // namespace lumen::convert
