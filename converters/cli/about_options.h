// SPDX-License-Identifier: Apache-2.0
// What people tell of a case and of a library, as options.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "converters/library/record.h"

namespace lumen::app {

/// What is given on the command line; the rest is empty.
struct AboutArguments {
  std::string file;  ///< --about
  std::string title, description, anatomy, laterality, modality, licence, attribution, doi, origin,
      consent, deidentification;
  std::vector<std::string> codes;
  bool synthetic = false;
};

void addAboutOptions(CLI::App& app, AboutArguments& about);

/// The statements of the command line, then those of the file, then `known`; `licence` where none of them has one. Throws
/// as convert::readAbout(), Error(InvalidInput) for a file that is not there.
convert::CaseAbout aboutOf(const AboutArguments& arguments, const convert::CaseAbout& known,
                           const std::string& licence);

/// A text of `least` to `most` bytes, UTF-8 without control characters.
CLI::Validator textOf(std::size_t least, std::size_t most);
/// An SPDX expression.
CLI::Validator licence();
/// YYYY-MM-DD.
CLI::Validator dayText();
CLI::Validator uuidText();
CLI::Validator caseIdText();

/// The day of a revision: `given`, or that of SOURCE_DATE_EPOCH, or today's in UTC. Throws Error(Usage) if
/// SOURCE_DATE_EPOCH is no number of seconds.
std::string revisionDay(const std::string& given);

/// The option --date of commands that make a revision.
void addDayOption(CLI::App& app, std::string& day);

}  // namespace lumen::app
