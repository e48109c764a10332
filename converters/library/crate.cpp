// SPDX-License-Identifier: Apache-2.0
#include "converters/library/crate.h"

#include <map>
#include <utility>

#include "converters/library/derived.h"
#include "converters/library/spdx.h"

namespace lumen::convert {

namespace {

constexpr const char* kVersion = "https://w3id.org/ro/crate/1.2";
// Profile of a crate that is referred to, in any version.
constexpr const char* kAnyVersion = "https://w3id.org/ro/crate";

std::string orElse(const std::string& text, const std::string& other) {
  return text.empty() ? other : text;
}

/// A name within the document: letters, digits, . and - stay.
std::string fragment(std::string_view kind, std::string_view text) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string id = "#" + std::string(kind) + "-";
  for (const char c : text) {
    const bool stays = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '.' || c == '-';
    const auto byte = static_cast<unsigned char>(c);
    if (stays)
      id += c;
    else
      id.append({'%', kDigits[byte >> 4], kDigits[byte & 0xfU]});
  }
  return id;
}

std::string codeId(const AnatomyCode& code) {
  return (code.system == "FMA" ? "http://purl.org/sig/ont/fma/fma" : "http://snomed.info/id/") +
         code.code;
}

CrateEntity codeEntity(const AnatomyCode& code) {
  return {{"@id", codeId(code)},
          {"@type", "DefinedTerm"},
          {"name", orElse(code.name, code.code)},
          {"termCode", code.code},
          {"inDefinedTermSet", code.system}};
}

std::string toolId(const std::string& tool) {
  return fragment("tool", tool);
}

std::string doiAddress(const CaseAbout& about) {
  return "https://doi.org/" + about.doi;
}

CrateEntity fileEntity(const RecordedFile& file) {
  static const std::map<std::string, const char*> kNames = {
      {"case", "The case: tree, wall points and models"},
      {"surface", "The closed surface of the case"},
      {"picture", "Picture of the case"},
      {"report", "Report on the case"}};
  const auto named = kNames.find(file.role);
  const std::string name = named != kNames.end()   ? named->second
                           : file.role == "export" ? file.path + ", for " + file.target
                                                   : file.path;
  return {{"@id", file.path},
          {"@type", "File"},
          {"name", name},
          {"encodingFormat", file.media},
          {"contentSize", std::to_string(file.bytes)},
          {"sha256", file.sha256}};
}

/// The case's own entity, "./".
CrateEntity rootOf(const CaseRecord& record) {
  CrateEntity root = caseEntity(record);
  root["@id"] = "./";
  root.erase("conformsTo");
  root["hasPart"] = CrateEntity::array({reference(kRecordFile)});
  for (const RecordedFile& file : record.files) root["hasPart"].push_back(reference(file.path));
  if (!record.about.doi.empty()) root["isBasedOn"] = reference(doiAddress(record.about));
  for (std::size_t i = 0; i < record.provenance["steps"].size(); ++i)
    root["mentions"].push_back(reference("#step-" + std::to_string(i + 1)));
  for (const RecordedFile& file : record.files)
    if (file.role == "picture") root["image"].push_back(reference(file.path));
  return root;
}

}  // namespace

std::string crateHead() {
  return "{\"@context\": \"" + std::string(kVersion) + "/context\", \"@graph\": [\n" +
         descriptor().dump();
}

std::string crateLine(const CrateEntity& entity) {
  return ",\n" + entity.dump();
}

std::string crateEnd() {
  return "\n]}\n";
}

CrateEntity reference(std::string_view id) {
  return {{"@id", id}};
}

CrateEntity descriptor() {
  return {{"@id", kCrateFile},
          {"@type", "CreativeWork"},
          {"conformsTo", reference(kVersion)},
          {"about", reference("./")}};
}

std::string licenceId(const std::string& expression) {
  if (isListedLicence(expression)) return "https://spdx.org/licenses/" + expression;
  return fragment("licence", expression);
}

CrateEntity licenceEntity(const std::string& expression) {
  return {{"@id", licenceId(expression)},
          {"@type", "CreativeWork"},
          {"name", expression},
          {"description", "Licence, as an SPDX expression: " + expression}};
}

CrateEntity libraryEntity(const LibraryFile& library) {
  CrateEntity root = {{"@id", "./"},
                      {"@type", "Dataset"},
                      {"identifier", "urn:uuid:" + library.id},
                      {"name", library.title},
                      {"description", orElse(library.description, library.title)},
                      {"datePublished", library.date},
                      {"version", std::to_string(library.revision)},
                      {"license", reference(licenceId(library.licence))}};
  if (!library.publisher.empty()) root["publisher"] = reference("#publisher");
  return root;
}

CrateEntity caseEntity(const CaseRecord& record) {
  const CaseAbout& about = record.about;
  CrateEntity entity = {{"@id", record.id + "/"},
                        {"@type", "Dataset"},
                        {"conformsTo", reference(kAnyVersion)},
                        {"name", about.title},
                        {"description", orElse(about.description, about.title)},
                        {"datePublished", record.date},
                        {"version", std::to_string(record.version)},
                        {"license", reference(licenceId(about.licence))}};
  if (!about.attribution.empty()) entity["creditText"] = about.attribution;
  if (!about.anatomy.empty()) entity["keywords"] = about.anatomy;
  for (const AnatomyCode& code : about.codes) entity["about"].push_back(reference(codeId(code)));
  return entity;
}

std::string caseCrate(const CaseRecord& record) {
  const CaseAbout& about = record.about;
  std::string text = crateHead() + crateLine(rootOf(record)) +
                     crateLine(licenceEntity(about.licence)) +
                     crateLine({{"@id", kRecordFile},
                                {"@type", "File"},
                                {"name", "All that is known of the case"},
                                {"encodingFormat", "application/json"}});
  for (const RecordedFile& file : record.files) text += crateLine(fileEntity(file));
  std::map<std::string, CrateEntity> others;  // each once, whatever refers to it
  for (const AnatomyCode& code : about.codes) others.emplace(codeId(code), codeEntity(code));
  if (!about.doi.empty())
    others.emplace(doiAddress(about), CrateEntity{{"@id", doiAddress(about)},
                                                  {"@type", "CreativeWork"},
                                                  {"name", orElse(about.origin, about.doi)}});
  std::size_t number = 0;
  for (const auto& step : record.provenance["steps"]) {
    const std::string tool = step["tool"];
    const std::string id = "#step-" + std::to_string(++number);
    others.emplace(
        toolId(tool),
        CrateEntity{{"@id", toolId(tool)}, {"@type", "SoftwareApplication"}, {"name", tool}});
    text += crateLine({{"@id", id},
                       {"@type", "CreateAction"},
                       {"name", step["name"]},
                       {"instrument", reference(toolId(tool))},
                       {"result", reference(kCaseFile)}});
  }
  for (const auto& [id, entity] : others) text += crateLine(entity);
  return text + crateEnd();
}

}  // namespace lumen::convert
