// SPDX-License-Identifier: Apache-2.0
// Check of the bag and the RO-Crate of a library against library.json and the records.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "converters/base/progress.h"
#include "converters/library/index/derived.h"
#include "converters/library/publish/check_case.h"

namespace lumen::convert {

/// The first line in which two texts differ, and the expected one; nothing for equal texts. Lines
/// of a manifest whose paths are in `passedOver`, or in its folders ("data/ID/"), do not count.
std::optional<std::pair<std::string, std::string>> firstDifference(
    std::string_view found, std::string_view expected,
    const std::set<std::string>& passedOver = {});

class BagCheck {
public:
  /// `library` has the cases sorted, each once; `text` is library.json. All must outlive this.
  BagCheck(const PlainFolder& folder, const LibraryFile& library, const std::string& text,
           const Progress& progress)
      : m_folder(folder),
        m_text(text),
        m_progress(progress),
        m_texts(library),
        m_library(library) {}

  /// Checks the next case. A record that is not there leaves the files that follow from it unknown.
  void add(const LibraryEntry& entry, const CaseCheck& check);
  /// Ends the check after the last case.
  void finish(FaultList& faults);

private:
  void compare(const std::string& path, const std::string& expected, FaultList& faults) const;

  const PlainFolder& m_folder;
  const std::string& m_text;
  const Progress& m_progress;
  LibraryTexts m_texts;
  const LibraryFile& m_library;
  std::set<std::string> m_unknown;  ///< paths and folders of which nothing is known
};

}  // namespace lumen::convert
