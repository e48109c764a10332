// SPDX-License-Identifier: Apache-2.0
// Looks in texts for what would tell who a patient is.
#pragma once

#include <string>
#include <string_view>

#include "formats/case/case.h"
#include "formats/container/issue.h"

namespace lumen::formats {

/// Reports what looks like a date, a path or URL, an e-mail address, an identification number, or a
/// person's title or name in DICOM's form. It cannot tell a bare name ("Smith") from an anatomical
/// one, so finding nothing proves nothing.
void scanText(std::string_view text, const std::string& pointer, IssueList& issues);

/// Every text that a case has: labels, the note, steps, parameters, units, names of arrays and
/// extensions, and the readable parts of other chunks.
void scanPrivacy(const Case& value, IssueList& issues);

/// The keys of a legal JSON text that start with "x-", and the texts in them; places follow `root`.
void scanComments(std::string_view text, const std::string& root, IssueList& issues);

}  // namespace lumen::formats
