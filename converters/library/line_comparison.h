// SPDX-License-Identifier: Apache-2.0
// Comparison of a text file with its expected text, line by line; neither is in memory as a whole.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "converters/base/progress.h"
#include "converters/library/plain_folder.h"

namespace lumen::convert {

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

}  // namespace lumen::convert
