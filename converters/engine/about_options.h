// SPDX-License-Identifier: Apache-2.0
// Rows of the statements of people about a case and a library.
#pragma once

#include <string>
#include <vector>

#include "converters/base/options/option_table.h"
#include "converters/library/index/record.h"

namespace lumen::engine {

/// Statements of the command line; those that are not given are empty.
struct AboutArguments {
  AboutArguments() { stated.laterality = stated.modality = ""; }
  std::string file;  ///< --about
  convert::CaseAbout stated;
  std::vector<std::string> codes;
};

/// Group of the rows of addAboutRows().
inline constexpr const char* kStatementsGroup = "Statements about the case";

void addAboutRows(OptionTable& table, AboutArguments& about);

/// The statements of the command line, then those of the file, then `known`; `licence` where none
/// of them has one. Throws as convert::readAbout(), Error(InvalidInput) for a file that is not
/// there.
convert::CaseAbout statedAbout(const AboutArguments& arguments, const convert::CaseAbout& known,
                               const std::string& licence);

/// Empties the texts of `about` whose options are given with an empty value.
void clearEmptied(const OptionTable& table, convert::CaseAbout& about);

/// A text of `least` to `most` bytes, UTF-8 without control characters.
ValueCheck checkTextLength(std::size_t least, std::size_t most);
/// An SPDX expression.
ValueCheck licence();
ValueCheck uuidText();
ValueCheck caseIdText();

/// The day of a revision: `given`, or that of SOURCE_DATE_EPOCH, or today's in UTC. Throws
/// Error(Usage) if SOURCE_DATE_EPOCH is no number of seconds.
std::string revisionDay(const std::string& given);

/// --date of commands that make a revision.
void addDayRow(OptionTable& table, std::string& day);
/// --max-faults of commands that judge a library.
void addFaultsRow(OptionTable& table, std::size_t& mostFaults);

}  // namespace lumen::engine
