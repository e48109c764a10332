// SPDX-License-Identifier: Apache-2.0
// The page of `lumen report`.
#pragma once

#include <string>

#include "converters/base/html.h"
#include "converters/draw/report/report_facts.h"

namespace lumen::convert {

/// One HTML file to read and to print on A4: it holds its pictures and style, has no script, and a
/// policy that lets it load nothing. Equal facts give equal bytes. One sentence reports each thing
/// that the case or the volume lacks.
std::string reportPage(const ReportFacts& facts);

// Sections of the page, each with its heading.
Markup branchSection(const ReportFacts& facts);      ///< report_vessels.cpp
Markup profileSection(const ReportFacts& facts);     ///< report_vessels.cpp
Markup measureSection(const ReportFacts& facts);     ///< report_measures.cpp
Markup confidenceSection(const ReportFacts& facts);  ///< report_vessels.cpp
Markup agreementSection(const ReportFacts& facts);   ///< report_agreement.cpp
/// Legend of the colours of agreement; `withMissing`: of missing vessels, too. report_agreement.cpp
Markup agreementLegend(bool withMissing);
Markup parameterSection(const ReportFacts& facts);   ///< report_provenance.cpp
Markup provenanceSection(const ReportFacts& facts);  ///< report_provenance.cpp

}  // namespace lumen::convert
