// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/about_options.h"

#include <chrono>
#include <cstdlib>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/number_text.h"
#include "converters/base/options/option_name.h"
#include "converters/library/index/json_values.h"
#include "converters/library/index/spdx.h"
#include "formats/container/printable.h"
#include "formats/view/text_rules.h"

namespace lumen::engine {

namespace {

std::string refusal(const std::string& found, const std::string& expected) {
  return "found " + formats::printable(found) + ", expected " + expected;
}

template <class Test>
ValueCheck checked(Test test, std::string expected) {
  return [test, expected = std::move(expected)](const std::string& text) {
    return test(text) ? std::string() : refusal(text, expected);
  };
}

bool isCode(const std::string& text) {
  const convert::AnatomyCode code = convert::parseCode(text);
  return (code.system == "SNOMED CT" || code.system == "FMA") && !code.code.empty() &&
         code.code.size() <= 18 && code.code.find_first_not_of("0123456789") == std::string::npos &&
         !formats::checkText(code.name, 255, "");
}

void addText(OptionTable& table, const std::string& name, std::string& value,
             const std::string& help, std::size_t most) {
  table.add(name, &value, "TEXT", help).checkedBy(checkTextLength(0, most));
}

void addWord(OptionTable& table, const std::string& name, std::string& value,
             const std::string& help, const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? ": " : ", ") + word;
  table.add(name, &value, "WORD", help + all).among(words);
}

void take(const std::string& given, std::string& value) {
  if (!given.empty()) value = given;
}

}  // namespace

ValueCheck checkTextLength(std::size_t least, std::size_t most) {
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

ValueCheck licence() {
  return [](const std::string& text) { return convert::licenceFault(text); };
}

ValueCheck uuidText() {
  return checked([](const std::string& text) { return convert::isUuid(text); },
                 "a UUID such as 0b8f2ac0-58a8-4d3c-93c9-3f3f39f1f2a4");
}

ValueCheck caseIdText() {
  return checked([](const std::string& text) { return convert::isCaseId(text); },
                 convert::kCaseIdRule);
}

void addAboutRows(OptionTable& table, AboutArguments& arguments) {
  convert::CaseAbout& about = arguments.stated;
  table.group(kStatementsGroup);
  table.file("about", arguments.file,
             "JSON file of the statements below, under the keys of record.json, or a record.json");
  addText(table, "title", about.title, "Title [the anatomy, or the id]", 255);
  addText(table, "description", about.description, "Description", 4096);
  addText(table, "anatomy", about.anatomy, "Anatomy, such as \"carotid siphon\"", 255);
  table
      .add("code", &arguments.codes, "CODE",
           "Anatomy as a code, such as \"SNOMED CT:86117002:Internal carotid artery\", or of FMA; "
           "may be repeated")
      .many()
      .checkedBy(checked(
          isCode, "SNOMED CT or FMA, the code's digits and its name, with colons between them"));
  addWord(table, "laterality", about.laterality, "Side of the body",
          {"left", "right", "bilateral", "midline", "unknown"});
  addWord(table, "modality", about.modality, "Modality of the source",
          {"XA", "CT", "MR", "US", "mesh", "synthetic", "other"});
  table
      .add(kOption.licence.name, &about.licence, "SPDX",
           "Licence, as an SPDX expression such as CC-BY-4.0 [the library's]")
      .checkedBy(licence());
  addText(table, "attribution", about.attribution, "Names to credit", 1024);
  table.add("doi", &about.doi, "DOI", "Digital object identifier, such as 10.5281/zenodo.1234")
      .checkedBy(checked(convert::isDoi, "a DOI such as 10.5281/zenodo.1234"));
  addText(table, "origin", about.origin, "Source of the data", 1024);
  addText(table, kOption.consent.name, about.consent,
          "Ground on which a patient's case may be given away; required unless " +
              kOption.synthetic.shown(),
          4096);
  addText(
      table, kOption.deidentification.name, about.deidentification,
      "Method by which identifying data were removed; required unless " + kOption.synthetic.shown(),
      4096);
  table.flag(kOption.synthetic.name, about.synthetic, "No patient is behind the case");
  table.group("");
}

convert::CaseAbout statedAbout(const AboutArguments& arguments, const convert::CaseAbout& known,
                               const std::string& licence) {
  convert::CaseAbout about = known;
  if (!arguments.file.empty())
    about = convert::readAbout(readWholeFile(arguments.file, "file about the case"), arguments.file,
                               known);
  const convert::CaseAbout& stated = arguments.stated;
  const bool statesModality = !stated.modality.empty() || about.modality != "other";
  about.synthetic = about.synthetic || stated.synthetic;
  if (about.synthetic && !statesModality) about.modality = "synthetic";
  if (about.licence.empty()) about.licence = licence;
  for (const convert::AboutText& one : convert::kAboutTexts)
    take(stated.*one.text, about.*one.text);
  take(stated.anatomy, about.anatomy);
  take(stated.laterality, about.laterality);
  take(stated.modality, about.modality);
  if (!arguments.codes.empty()) about.codes.clear();
  for (const std::string& code : arguments.codes) about.codes.push_back(convert::parseCode(code));
  return about;
}

void clearEmptied(const OptionTable& table, convert::CaseAbout& about) {
  const auto clear = [&table](const char* name, std::string& text) {
    if (const OptionRow& row = *table.find(name); row.isGiven && row.givenValues.back().empty())
      text.clear();
  };
  for (const convert::AboutText& one : convert::kAboutTexts)
    if (one.text != &convert::CaseAbout::licence) clear(one.key, about.*one.text);
  clear("anatomy", about.anatomy);
}

std::string revisionDay(const std::string& given) {
  if (!given.empty()) return given;
  using namespace std::chrono;
  sys_days day = floor<days>(system_clock::now());
  if (const char* const epoch = std::getenv("SOURCE_DATE_EPOCH"); epoch != nullptr) {
    char* end = nullptr;
    const long long value = std::strtoll(epoch, &end, 10);
    constexpr long long kLatestSecond = 253402300799;  // the last second of the year 9999
    if (*epoch == '\0' || *end != '\0' || value < 0 || value > kLatestSecond)
      throw Error(ErrorKind::Usage,
                  "SOURCE_DATE_EPOCH: " + refusal(epoch, "seconds since 1970 in decimal digits"));
    day = floor<days>(sys_seconds(seconds(value)));
  }
  const year_month_day date(day);
  return paddedNumber(static_cast<std::uint64_t>(static_cast<int>(date.year())), 4) + "-" +
         paddedNumber(static_cast<unsigned>(date.month()), 2) + "-" +
         paddedNumber(static_cast<unsigned>(date.day()), 2);
}

void addDayRow(OptionTable& table, std::string& day) {
  table
      .add("date", &day, "DAY",
           "Date of the library's revision, YYYY-MM-DD [SOURCE_DATE_EPOCH, or today]")
      .checkedBy(checked([](const std::string& text) { return convert::isDay(text); },
                         "a date such as 2026-11-22"));
}

void addFaultsRow(OptionTable& table, std::size_t& mostFaults) {
  table.add("max-faults", &mostFaults, "N", "Report at most N faults; all are counted")
      .in(WholeRange{0, 1000000});
}

}  // namespace lumen::engine
