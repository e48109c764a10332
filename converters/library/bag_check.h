// SPDX-License-Identifier: Apache-2.0
// Check of the bag and the RO-Crate of a library against library.json and the records. One case at
// a time is in memory.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "converters/base/progress.h"
#include "converters/library/check_case.h"
#include "converters/library/derived.h"
#include "converters/library/library_fault.h"
#include "converters/library/library_file.h"
#include "converters/library/plain_folder.h"

namespace lumen::convert {

/// Comparison of a text file with its expected text, line by line; neither is in memory as a whole.
class LineComparison {
public:
  LineComparison(const PlainFolder& folder, const std::string& path, const Progress& progress);

  /// Compares the next text with the file. Throws Error(Cancelled).
  void expect(std::string_view text);
  /// Passes over the lines of the file that have `part` in them, up to the first that has not.
  void skip(std::string_view part);
  /// Nothing should follow.
  void finish();

  /// Reason why the file is not the expected one: PlainFault for one that is not had, or the first
  /// other line.
  [[nodiscard]] bool isOther() const { return !m_found.empty(); }
  [[nodiscard]] const std::string& found() const { return m_found; }
  [[nodiscard]] const std::string& expected() const { return m_expected; }

private:
  bool peek();
  void compare(std::string_view line);
  void differ(const std::string& found, const std::string& expected);

  std::unique_ptr<PlainStream> m_stream;
  const Progress& m_progress;
  std::string m_buffer;  ///< bytes of the file, from m_at on
  std::size_t m_at = 0;
  std::string m_line;  ///< the next of the file, if m_hasLine
  bool m_hasLine = false;
  std::string m_partial;  ///< expected text of a line that has not ended
  std::size_t m_number = 0;
  std::string m_found, m_expected;
};

class BagCheck {
public:
  /// `library` has the cases sorted, each once; `text` is library.json. All must outlive this.
  BagCheck(const PlainFolder& folder, const LibraryFile& library, const std::string& text,
           const Progress& progress);

  /// Checks the next case. A record that is not there leaves the files that follow from it unknown.
  void add(const LibraryEntry& entry, const CaseCheck& check);
  /// Ends the check after the last case.
  void finish(FaultList& faults);

private:
  void compare(const std::string& path, const std::string& expected, FaultList& faults) const;

  const PlainFolder& m_folder;
  const LibraryFile& m_library;
  const std::string& m_text;
  const Progress& m_progress;
  bool m_isWhole = true;  ///< all records so far are those that the library states
  LineComparison m_manifest, m_crate;
  LibraryTexts m_texts;
};

}  // namespace lumen::convert
