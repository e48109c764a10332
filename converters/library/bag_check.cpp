// SPDX-License-Identifier: Apache-2.0
#include "converters/library/bag_check.h"

#include <algorithm>
#include <utility>

#include "converters/base/shown_text.h"

namespace lumen::convert {

namespace {

const std::string kRootCrate = std::string(kPayload) + "/" + kCrateFile;

constexpr std::size_t kComparedPiece = std::size_t{1} << 16;
// The longest line is that of the parts of a library: 100,000 ids of 64 letters. Longer ones are
// cut, so they differ.
constexpr std::size_t kLongest = std::size_t{1} << 24;

void reportOther(const LineComparison& file, FaultCode code, const std::string& path,
                 FaultList& faults) {
  if (file.isOther()) faults.add({code, "", path, file.found(), file.expected()});
}

}  // namespace

LineComparison::LineComparison(const PlainFolder& folder, const std::string& path,
                               const Progress& progress)
    : m_progress(progress) {
  PlainRead why;
  m_stream = folder.stream(path, why);
  if (!m_stream) differ(why.found, "a file");
}

void LineComparison::differ(const std::string& found, const std::string& expected) {
  if (isOther()) return;
  m_found = found;
  m_expected = expected;
}

/// Whether there is a next line, which is then in m_line.
bool LineComparison::peek() {
  if (m_hasLine) return true;
  if (!m_stream) return false;
  while (true) {
    const std::size_t end = m_buffer.find('\n', m_at);
    const bool isWhole = end != std::string::npos;
    if (isWhole || m_buffer.size() - m_at > kLongest) {
      m_line = m_buffer.substr(m_at, isWhole ? end - m_at : kLongest);
      m_at = isWhole ? end + 1 : m_at + kLongest;
      return m_hasLine = true;
    }
    m_progress.check();
    m_buffer.erase(0, m_at);
    m_at = 0;
    std::string piece = m_stream->read(kComparedPiece);
    if (piece.empty()) break;
    m_buffer += piece;
  }
  if (m_buffer.empty()) return false;
  m_line = std::move(m_buffer) + " (and no line end)";
  m_buffer.clear();
  return m_hasLine = true;
}

void LineComparison::compare(std::string_view line) {
  ++m_number;
  const std::string where = "line " + std::to_string(m_number) + " ";
  if (!peek())
    return differ("nothing from line " + std::to_string(m_number) + " on",
                  quotedText(std::string(line)));
  m_hasLine = false;
  if (m_line == line) return;
  // long lines begin alike: shown from a little before the place
  const auto [a, b] = std::mismatch(m_line.begin(), m_line.end(), line.begin(), line.end());
  const auto same = static_cast<std::size_t>(a - m_line.begin());
  const std::size_t from = same > 40 && line.size() > 80 ? same - 20 : 0;
  differ(where + quotedText(m_line.substr(from)), quotedText(std::string(line.substr(from))));
}

void LineComparison::expect(std::string_view text) {
  while (!isOther() && !text.empty()) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) {
      m_partial += text;
      return;
    }
    if (m_partial.empty()) {
      compare(text.substr(0, end));
    } else {
      m_partial += text.substr(0, end);
      compare(m_partial);
      m_partial.clear();
    }
    text.remove_prefix(end + 1);
  }
}

void LineComparison::skip(std::string_view part) {
  while (!isOther() && peek() && m_line.find(part) != std::string::npos) {
    m_hasLine = false;
    ++m_number;
  }
}

void LineComparison::finish() {
  if (!isOther() && peek())
    differ("line " + std::to_string(m_number + 1) + " " + quotedText(m_line), "no more lines");
}

BagCheck::BagCheck(const PlainFolder& folder, const LibraryFile& library, const std::string& text,
                   const Progress& progress)
    : m_folder(folder),
      m_library(library),
      m_text(text),
      m_progress(progress),
      m_manifest(folder, kManifestFile, progress),
      m_crate(folder, kRootCrate, progress),
      m_texts(
          library, [this](std::string_view more) { m_manifest.expect(more); },
          [this](std::string_view more) {
            if (m_isWhole) m_crate.expect(more);
          }) {}

void BagCheck::add(const LibraryEntry& entry, const CaseCheck& check) {
  if (check.record) return m_texts.add(*check.record, check.crate);
  m_isWhole = false;
  m_texts.skip();
  m_manifest.skip("  " + std::string(kPayload) + "/" + entry.id + "/");
}

/// A small file of the bag.
void BagCheck::compare(const std::string& path, const std::string& expected,
                       FaultList& faults) const {
  LineComparison file(m_folder, path, m_progress);
  file.expect(expected);
  file.finish();
  reportOther(file, FaultCode::Bag, path, faults);
}

void BagCheck::finish(FaultList& faults) {
  if (m_isWhole) {
    TagTexts tags = m_texts.finish();
    // library.json may be written in another way of equal content
    const std::string written = sha256(libraryText(m_library));
    if (const std::size_t at = tags.tagManifest.find(written); at != std::string::npos)
      tags.tagManifest.replace(at, written.size(), sha256(m_text));
    compare(kBagFile, tags.bag, faults);
    compare(kBagInfoFile, tags.bagInfo, faults);
    m_crate.finish();
    compare(kTagManifestFile, tags.tagManifest, faults);
  } else {
    m_manifest.skip("  " + kRootCrate);
  }
  m_manifest.finish();
  reportOther(m_manifest, FaultCode::Bag, kManifestFile, faults);
  reportOther(m_crate, FaultCode::Crate, kRootCrate, faults);
}

}  // namespace lumen::convert
