// SPDX-License-Identifier: Apache-2.0
#include "converters/library/bag_check.h"

#include <span>
#include <string_view>

#include "converters/base/sha256.h"
#include "converters/library/derived.h"
#include "converters/library/line_comparison.h"

namespace lumen::convert {

namespace {

const std::string kRootCrate = std::string(kPayload) + "/" + kCrateFile;

std::string digestOf(const std::string& text) {
  return sha256(std::as_bytes(std::span(text)));
}

}  // namespace

struct BagCheck::State {
  State(const PlainFolder& given, const LibraryFile& stated, const std::string& libraryText,
        const Progress& watch)
      : folder(given),
        library(stated),
        text(libraryText),
        progress(watch),
        manifest(given, kManifestFile, watch),
        crate(given, kRootCrate, watch),
        texts(
            stated, [this](std::string_view more) { manifest.expect(more); },
            [this](std::string_view more) {
              if (isWhole) crate.expect(more);
            }) {}

  /// A small file of the bag.
  void compare(const std::string& path, const std::string& expected, FaultList& faults) const {
    LineComparison file(folder, path, progress);
    file.expect(expected);
    file.finish();
    report(file, FaultCode::Bag, path, faults);
  }
  static void report(const LineComparison& file, FaultCode code, const std::string& path,
                     FaultList& faults) {
    if (file.isOther()) faults.add({code, "", path, file.found(), file.expected()});
  }

  const PlainFolder& folder;
  const LibraryFile& library;
  const std::string& text;
  const Progress& progress;
  bool isWhole = true;  ///< all records so far are those that the library states
  LineComparison manifest, crate;
  LibraryTexts texts;
};

BagCheck::BagCheck(const PlainFolder& folder, const LibraryFile& library, const std::string& text,
                   const Progress& progress)
    : m_state(std::make_unique<State>(folder, library, text, progress)) {}

BagCheck::~BagCheck() = default;

void BagCheck::add(const LibraryEntry& entry, const CaseCheck& check) {
  if (check.record) return m_state->texts.add(*check.record, check.crate);
  m_state->isWhole = false;
  m_state->texts.skip();
  m_state->manifest.skip("  " + std::string(kPayload) + "/" + entry.id + "/");
}

void BagCheck::finish(FaultList& faults) {
  State& state = *m_state;
  if (state.isWhole) {
    TagTexts tags = state.texts.finish();
    // library.json may be written in another way of equal content
    const std::string written = digestOf(libraryText(state.library));
    if (const std::size_t at = tags.tagManifest.find(written); at != std::string::npos)
      tags.tagManifest.replace(at, written.size(), digestOf(state.text));
    state.compare(kBagFile, tags.bag, faults);
    state.compare(kBagInfoFile, tags.bagInfo, faults);
    state.crate.finish();
    state.compare(kTagManifestFile, tags.tagManifest, faults);
  } else {
    state.manifest.skip("  " + kRootCrate);
  }
  state.manifest.finish();
  State::report(state.manifest, FaultCode::Bag, kManifestFile, faults);
  State::report(state.crate, FaultCode::Crate, kRootCrate, faults);
}

}  // namespace lumen::convert
