// SPDX-License-Identifier: Apache-2.0
// The page of `lumen report`.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/html.h"
#include "converters/judge/check/check.h"
#include "converters/judge/facts/case_info.h"
#include "converters/judge/facts/check_facts.h"
#include "converters/judge/facts/examination.h"
#include "converters/judge/measure/measures.h"
#include "formats/case/case.h"

namespace lumen::convert {

// Tables of the report.

struct Column {
  std::string title;
  bool isNumber = true;
};

/// A table whose head is repeated on each page and whose rows are not cut.
class Table {
public:
  Table(std::string id, std::vector<Column> columns)
      : m_id(std::move(id)), m_columns(std::move(columns)) {}

  /// One cell for each column.
  void row(const std::vector<Markup>& cells);
  [[nodiscard]] std::size_t rows() const { return m_count; }
  [[nodiscard]] Markup markup() const;

private:
  std::string m_id;
  std::vector<Column> m_columns;
  std::string m_rows;
  std::size_t m_count = 0;
};

// Facts on the page of `lumen report`.

/// A picture in the PNG format.
struct DrawnView {
  std::string title;
  std::string png;
  int width = 0, height = 0;  ///< pixels
};

/// The volume that the case is held against.
struct ReportVolume {
  std::string name;  ///< the file's
  formats::SourceVolume geometry;
  SourceRelation source;
  std::optional<convert::CheckReport> check;  ///< none of a case without models
  std::vector<DrawnView> projections;         ///< one scale for all; they show the tree, too
};

struct ReportFacts {
  std::string title;
  std::string caseName;   ///< the file's
  std::size_t bytes = 0;  ///< size of the file
  std::string sha256;     ///< digest of the file
  formats::Case value;
  CaseInfo info;
  CaseMeasures measures;
  FileReport examination;
  /// Warnings about the closed surface, reading the volume, how the case lies in it, and names of
  /// files.
  std::vector<std::string> otherWarnings;
  std::vector<DrawnView> sides;         ///< none of a case without models
  std::optional<DrawnView> confidence;  ///< none if a case without models or inlier rates
  std::optional<ReportVolume> volume;   ///< none without --volume

  /// Number of warnings, without notes.
  [[nodiscard]] std::size_t warnings() const {
    return examination.counts.warnings + otherWarnings.size();
  }
};

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
