// SPDX-License-Identifier: Apache-2.0
#include "converters/library/index/derived.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "converters/base/sha256.h"
#include "converters/library/index/spdx.h"

namespace lumen::convert {

namespace {

// Entities of RO-Crate 1.2 (https://w3id.org/ro/crate/1.2).

using CrateEntity = nlohmann::ordered_json;

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

CrateEntity reference(std::string_view id) {
  return {{"@id", id}};
}

/// The document up to its first entity, that of the metadata file itself: one entity on each line.
std::string crateHead() {
  const CrateEntity descriptor = {{"@id", kCrateFile},
                                  {"@type", "CreativeWork"},
                                  {"conformsTo", reference(kVersion)},
                                  {"about", reference("./")}};
  return "{\"@context\": \"" + std::string(kVersion) + "/context\", \"@graph\": [\n" +
         descriptor.dump();
}

/// The next entity.
std::string crateLine(const CrateEntity& entity) {
  return ",\n" + entity.dump();
}

std::string crateEnd() {
  return "\n]}\n";
}

/// Identifier that refers to a licence expression: its page at SPDX, or a name within the document.
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

/// The library's own entity, "./", but for its parts.
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

/// A case in the crate of its library: a folder with a crate of its own.
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

std::string manifestLine(std::string_view digest, std::string_view path) {
  return std::string(digest) + "  " + std::string(path) + "\n";
}

/// The lines of a case, sorted by path.
std::string manifestLines(const CaseRecord& record, const LibraryEntry& entry,
                          std::string_view crate) {
  std::vector<std::pair<std::string, std::string>> lines = {{kRecordFile, entry.recordSha256},
                                                            {kCrateFile, sha256(crate)}};
  for (const RecordedFile& file : record.files) lines.emplace_back(file.path, file.sha256);
  std::sort(lines.begin(), lines.end());
  std::string text;
  for (const auto& [path, digest] : lines)
    text += manifestLine(digest, std::string(kPayload) + "/" + record.id + "/" + path);
  return text;
}

std::string bagInfo(const LibraryFile& library, std::uint64_t bytes, std::uint64_t files) {
  std::string text = "Bagging-Date: " + library.date + "\n" +
                     "Payload-Oxum: " + std::to_string(bytes) + "." + std::to_string(files) + "\n" +
                     "External-Identifier: urn:uuid:" + library.id + "\n" +
                     "External-Description: " + library.title + "\n";
  if (!library.publisher.empty()) text += "Source-Organization: " + library.publisher + "\n";
  return text + "Bag-Software-Agent: " + library.generator + "\n";
}

}  // namespace

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

LibraryTexts::LibraryTexts(const LibraryFile& library)
    : m_library(library), m_licences{library.licence} {
  CrateEntity root = libraryEntity(library);
  root["hasPart"] = CrateEntity::array();
  for (const LibraryEntry& entry : library.cases)
    root["hasPart"].push_back(reference(entry.id + "/"));
  m_texts.crate = crateHead() + crateLine(root);
  if (!library.publisher.empty())
    m_texts.crate +=
        crateLine({{"@id", "#publisher"}, {"@type", "Organization"}, {"name", library.publisher}});
}

void LibraryTexts::add(const LibraryEntry& entry, const CaseRecord& record,
                       std::string_view crate) {
  m_texts.manifest += manifestLines(record, entry, crate);
  CrateEntity entity = caseEntity(record);
  entity.erase("about");  // its codes are in the crate of the case
  m_texts.crate += crateLine(entity);
  m_licences.insert(record.about.licence);
  m_files += entry.files + 2;
  m_bytes += entry.bytes + entry.recordBytes + crate.size();
}

RevisionTexts LibraryTexts::finish() {
  RevisionTexts texts = std::move(m_texts);
  for (const std::string& licence : m_licences) texts.crate += crateLine(licenceEntity(licence));
  texts.crate += crateEnd();
  texts.manifest += manifestLine(sha256(texts.crate), kRootCrate);
  texts.bag = "BagIt-Version: 1.0\nTag-File-Character-Encoding: UTF-8\n";
  texts.bagInfo = bagInfo(m_library, m_bytes + texts.crate.size(), m_files + 1);
  texts.tagManifest = manifestLine(sha256(texts.bagInfo), kBagInfoFile) +
                      manifestLine(sha256(texts.bag), kBagFile) +
                      manifestLine(sha256(libraryText(m_library)), kLibraryFile) +
                      manifestLine(sha256(texts.manifest), kManifestFile);
  return texts;
}

}  // namespace lumen::convert
