// SPDX-License-Identifier: Apache-2.0
// Warning before a case is given away: texts that may identify a patient. The check knows patterns,
// not people: a bare name ("Smith") looks like an anatomical one, so a case without findings may
// still hold one.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lumen {

struct PrivacyFinding {
  std::string_view code;  ///< PRIVACY_DATE, _PATH, _ADDRESS, _NUMBER or _NAME
  int number = 0;         ///< 601 to 605, which no rule of the format uses
  std::string pointer;    ///< JSON pointer into the JSON encoding
  std::string found;      ///< the beginning of the text
  std::string message;
};

/// Texts that look like a date, a path or URL, an e-mail address, an identification number, or a
/// person's title or name in DICOM's form.
std::vector<PrivacyFinding> scanText(std::string_view text, const std::string& pointer);

/// Findings in every text of a case file of either encoding: labels, the note, steps, parameters,
/// units, names, comments, and the readable parts of other chunks. Empty for a file that is not
/// valid.
std::vector<PrivacyFinding> scanPrivacy(std::span<const std::byte> file);

}  // namespace lumen
