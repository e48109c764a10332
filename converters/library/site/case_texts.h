// SPDX-License-Identifier: Apache-2.0
// Words for codes in a record, and places of a case in the library's folder.
#pragma once

#include <string>

#include "converters/library/record.h"

namespace lumen::convert {

std::string sideText(const std::string& laterality);     ///< "left", "side not stated"
std::string modalityText(const std::string& modality);   ///< "XA angiography"
std::string galleryFigures(const CaseFigures& figures);  ///< HTML: vessels, length, radii
std::string doiLink(const std::string& doi);  ///< HTML: link to a DOI's page; empty without one
double rounded(double value);                 ///< to 0.01
std::string dataPath(const CaseRecord& record, const std::string& path);  ///< "data/ID/PATH"
std::string casePagePath(const std::string& id);                          ///< "site/case/ID.html"

}  // namespace lumen::convert
