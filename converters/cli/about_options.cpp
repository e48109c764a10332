// SPDX-License-Identifier: Apache-2.0
#include "converters/cli/about_options.h"

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/cli/value_checks.h"
#include "converters/library/json_values.h"
#include "converters/library/spdx.h"
#include "formats/container/printable.h"
#include "formats/view/text_rules.h"

namespace lumen::app {

namespace {

constexpr const char* kGroup = "What is told of the case";

std::string refusal(const std::string& found, const std::string& expected) {
  return "found " + formats::printable(found) + ", expected " + expected;
}

template <class Test>
CLI::Validator checked(Test test, std::string expected) {
  return CLI::Validator(
      [test, expected = std::move(expected)](const std::string& text) {
        return test(text) ? std::string() : refusal(text, expected);
      },
      "");
}

/// "SNOMED CT:86117002:Internal carotid artery".
convert::AnatomyCode codeOf(const std::string& text) {
  const std::size_t first = text.find(':');
  const std::size_t second = first == std::string::npos ? first : text.find(':', first + 1);
  if (second == std::string::npos) return {};
  return {text.substr(0, first), text.substr(first + 1, second - first - 1),
          text.substr(second + 1)};
}

bool isCode(const std::string& text) {
  const convert::AnatomyCode code = codeOf(text);
  return (code.system == "SNOMED CT" || code.system == "FMA") && !code.code.empty() &&
         code.code.size() <= 18 && code.code.find_first_not_of("0123456789") == std::string::npos &&
         !formats::checkText(code.name, 255, "");
}

void addText(CLI::App& app, const std::string& name, std::string& value, const std::string& help,
             std::size_t most) {
  app.add_option(name, value, help)->type_name("TEXT")->group(kGroup)->check(textOf(0, most));
}

void addWord(CLI::App& app, const std::string& name, std::string& value, const std::string& help,
             const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? ": " : ", ") + word;
  app.add_option(name, value, help + all)->type_name("WORD")->group(kGroup)->check(oneOf(words));
}

void take(const std::string& given, std::string& value) {
  if (!given.empty()) value = given;
}

}  // namespace

CLI::Validator textOf(std::size_t least, std::size_t most) {
  return checked(
      [=](const std::string& text) {
        return text.size() >= least && !formats::checkText(text, most, "");
      },
      std::string("a text of ")
          .append(std::to_string(least))
          .append(" to ")
          .append(std::to_string(most))
          .append(" bytes of UTF-8 without control characters"));
}

CLI::Validator licence() {
  return CLI::Validator([](const std::string& text) { return convert::licenceFault(text); }, "");
}

CLI::Validator dayText() {
  return checked([](const std::string& text) { return convert::isDay(text); },
                 "a date such as 2026-11-22");
}

CLI::Validator uuidText() {
  return checked([](const std::string& text) { return convert::isUuid(text); },
                 "a UUID such as 0b8f2ac0-58a8-4d3c-93c9-3f3f39f1f2a4");
}

CLI::Validator caseIdText() {
  return checked([](const std::string& text) { return convert::isCaseId(text); },
                 convert::kCaseIdRule);
}

void addAboutOptions(CLI::App& app, AboutArguments& about) {
  addFile(app, "--about", about.file,
          "JSON file of the statements below, under the keys of record.json, or a record.json")
      ->required(false)
      ->group(kGroup);
  addText(app, "--title", about.title, "Title [the anatomy, or the id]", 255);
  addText(app, "--description", about.description, "Description", 4096);
  addText(app, "--anatomy", about.anatomy, "What the vessels are, such as \"carotid siphon\"", 255);
  app.add_option(
         "--code", about.codes,
         "The same as a code, such as \"SNOMED CT:86117002:Internal carotid artery\", or of "
         "FMA; may be repeated")
      ->type_name("CODE")
      ->group(kGroup)
      ->allow_extra_args(false)
      ->check(checked(
          isCode, "SNOMED CT or FMA, the code's digits and its name, with colons between them"));
  addWord(app, "--laterality", about.laterality, "Side of the body",
          {"left", "right", "bilateral", "midline", "unknown"});
  addWord(app, "--modality", about.modality, "What the source was",
          {"XA", "CT", "MR", "US", "mesh", "synthetic", "other"});
  app.add_option("--licence", about.licence,
                 "Licence, as an SPDX expression such as CC-BY-4.0 [the library's]")
      ->type_name("SPDX")
      ->group(kGroup)
      ->check(licence());
  addText(app, "--attribution", about.attribution, "Whom to name", 1024);
  app.add_option("--doi", about.doi, "Digital object identifier, such as 10.5281/zenodo.1234")
      ->type_name("DOI")
      ->group(kGroup)
      ->check(checked(convert::isDoi, "a DOI such as 10.5281/zenodo.1234"));
  addText(app, "--origin", about.origin, "Where the data come from", 1024);
  addText(app, "--consent", about.consent,
          "On what ground a patient's case may be given away; must be told unless --synthetic",
          4096);
  addText(app, "--deidentification", about.deidentification,
          "How it was freed from what tells who the patient is; must be told unless --synthetic",
          4096);
  app.add_flag("--synthetic", about.synthetic, "No patient is behind the case")->group(kGroup);
}

convert::CaseAbout aboutOf(const AboutArguments& arguments, const convert::CaseAbout& known,
                           const std::string& licence) {
  convert::CaseAbout about = known;
  if (!arguments.file.empty())
    about = convert::readAbout(readWholeFile(arguments.file, "file about the case"), arguments.file,
                               known);
  const bool statesModality = !arguments.modality.empty() || about.modality != "other";
  about.synthetic = about.synthetic || arguments.synthetic;
  take(arguments.title, about.title);
  take(arguments.description, about.description);
  take(arguments.anatomy, about.anatomy);
  take(arguments.laterality, about.laterality);
  if (about.synthetic && !statesModality) about.modality = "synthetic";
  take(arguments.modality, about.modality);
  if (about.licence.empty()) about.licence = licence;
  take(arguments.licence, about.licence);
  take(arguments.attribution, about.attribution);
  take(arguments.doi, about.doi);
  take(arguments.origin, about.origin);
  take(arguments.consent, about.consent);
  take(arguments.deidentification, about.deidentification);
  if (!arguments.codes.empty()) about.codes.clear();
  for (const std::string& code : arguments.codes) about.codes.push_back(codeOf(code));
  return about;
}

std::string revisionDay(const std::string& given) {
  if (!given.empty()) return given;
  using namespace std::chrono;
  sys_days day = floor<days>(system_clock::now());
  if (const char* const epoch = std::getenv("SOURCE_DATE_EPOCH"); epoch != nullptr) {
    char* end = nullptr;
    const long long value = std::strtoll(epoch, &end, 10);
    constexpr long long kMost = 253402300799;  // the last second of the year 9999
    if (*epoch == '\0' || *end != '\0' || value < 0 || value > kMost)
      throw Error(ErrorKind::Usage,
                  "SOURCE_DATE_EPOCH: " + refusal(epoch, "seconds since 1970 in decimal digits"));
    day = floor<days>(sys_seconds(seconds(value)));
  }
  const year_month_day date(day);
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%04d-%02u-%02u", static_cast<int>(date.year()),
                static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()));
  return text.data();
}

void addDayOption(CLI::App& app, std::string& day) {
  app.add_option("--date", day,
                 "Date of the library's revision, YYYY-MM-DD [SOURCE_DATE_EPOCH, or today]")
      ->type_name("DAY")
      ->check(dayText());
}

}  // namespace lumen::app
