// SPDX-License-Identifier: Apache-2.0
#include "unit/formats/spec_tables.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <regex>
#include <set>

#include <nlohmann/json.hpp>

#include "formats/container/error_code.h"

namespace lumen::formats::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::array<const char*, 15> kSchemas = {
    "case",        "metadata", "source",    "point-quantisation",
    "node-array",  "step",     "tree",      "branch",
    "link",        "points",   "models",    "motion",
    "other-chunk", "vector",   "quaternion"};

constexpr const char* kBegin = "<!-- properties: begin -->\n";
constexpr const char* kEnd = "<!-- properties: end -->";

std::string numberText(const Json& value) {
  return value.dump();
}

std::string rangeText(const Json& schema) {
  std::string text;
  const auto add = [&](const char* key, const std::string& before) {
    if (schema.contains(key)) text += (text.empty() ? "" : ", ") + before + numberText(schema[key]);
  };
  add("exclusiveMinimum", "> ");
  add("minimum", ">= ");
  add("maximum", "<= ");
  return text;
}

std::string sizeText(const Json& schema, const char* least, const char* most, const char* what) {
  const bool hasLeast = schema.contains(least), hasMost = schema.contains(most);
  if (hasLeast && hasMost && schema[least] == schema[most])
    return numberText(schema[least]) + " " + what;
  std::string text;
  if (hasLeast) text += "at least " + numberText(schema[least]);
  if (hasMost) text += (text.empty() ? "at most " : ", at most ") + numberText(schema[most]);
  return text.empty() ? text : text + " " + what;
}

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts)
    if (!part.empty()) text += (text.empty() ? "" : "; ") + part;
  return text;
}

std::string typeText(const Json& schema);

std::string itemText(const Json& schema) {
  const std::string type = typeText(schema), range = rangeText(schema);
  return range.empty() ? type : type + " " + range;
}

std::string typeText(const Json& schema) {
  if (schema.contains("$ref")) {
    std::string name = schema["$ref"];
    name.resize(name.find('.'));
    return "[" + name + "](#property-" + name + ")";
  }
  if (schema.contains("const")) return "`" + schema["const"].get<std::string>() + "`";
  if (schema.contains("enum")) {
    std::string text;
    for (const auto& value : schema["enum"])
      text += (text.empty() ? "`" : ", `") + value.get<std::string>() + "`";
    return text;
  }
  const std::string type = schema.at("type");
  if (type == "array") return "array of " + itemText(schema["items"]);
  if (type == "object" && schema["additionalProperties"].is_object() &&
      schema["additionalProperties"].contains("type"))
    return "object of " + itemText(schema["additionalProperties"]);
  return type;
}

std::string constraintText(const Json& schema) {
  std::string pattern;
  if (schema.contains("pattern"))
    pattern = "`" +
              std::regex_replace(schema["pattern"].get<std::string>(), std::regex("\\|"), "\\|") +
              "`";
  return joined({rangeText(schema), sizeText(schema, "minItems", "maxItems", "entries"),
                 sizeText(schema, "minLength", "maxLength", "characters"),
                 sizeText(schema, "minProperties", "maxProperties", "keys"), pattern});
}

std::string escaped(const std::string& text) {
  return std::regex_replace(text, std::regex("\\|"), "\\|");
}

// Description of a schema, or of the one that it refers to if it has none of its own.
std::string descriptionOf(const Json& schema, const std::map<std::string, Json>& all) {
  if (schema.contains("description")) return schema["description"];
  if (schema.contains("$ref")) {
    std::string name = schema["$ref"];
    name.resize(name.find('.'));
    return all.at(name).at("description");
  }
  return "";
}

std::string table(const std::string& name, const std::map<std::string, Json>& all) {
  const Json& schema = all.at(name);
  std::string text = "<a id=\"property-" + name + "\"></a>\n### " +
                     schema["title"].get<std::string>() + "\n\n[" + name + ".schema.json](schema/" +
                     name + ".schema.json). " + schema["description"].get<std::string>() + "\n\n";
  if (!schema.contains("properties"))
    return text + "An " + itemText(schema) + "; " + constraintText(schema) + ".\n\n";
  std::set<std::string> required;
  if (schema.contains("required"))
    for (const auto& key : schema["required"]) required.insert(key.get<std::string>());
  text += "| key | | type | range | unit | meaning |\n|---|---|---|---|---|---|\n";
  for (const auto& [key, value] : schema["properties"].items()) {
    const std::string unit = value.contains("x-unit") ? value["x-unit"].get<std::string>() : "";
    text += "| `" + key + "` | " + (required.count(key) > 0 ? "r" : "") + " | " + typeText(value) +
            " | " + constraintText(value) + " | " + unit + " | " +
            escaped(descriptionOf(value, all)) + " |\n";
  }
  return text + "\n";
}

// Numbers of requirements in the form "[M12]".
const std::regex kNumber("\\[(M[0-9]+)\\]");

std::vector<fs::path> sources(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().string();
    if (name.find("node_modules") != std::string::npos) continue;
    const auto extension = entry.path().extension();
    if (extension == ".cpp" || extension == ".py") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

int numberOf(const std::string& requirement) {
  return std::stoi(requirement.substr(1));
}

// The test files that have the quoted code.
std::string filesWith(const std::string& code, const std::map<std::string, std::string>& texts) {
  std::string files;
  for (const auto& [name, text] : texts)
    if (text.find("\"" + code + "\"") != std::string::npos)
      files += (files.empty() ? "" : ", ") + name;
  return files;
}

// Findings of lumen validate beyond the rules.
constexpr const char* kFindings =
    "\n<a id=\"findings\"></a>\n"
    "## Findings of lumen validate\n\n"
    "Warnings, which are errors under `--strict`. `--privacy` alone looks for those from 601 to\n"
    "605, which then lead to exit code 3.\n\n"
    "| number | code | arguments | meaning |\n|---|---|---|---|\n"
    "| 601 | `PRIVACY_DATE` | found | a text has what may be a date |\n"
    "| 602 | `PRIVACY_PATH` | found | a text has what may be a path or the address of a file |\n"
    "| 603 | `PRIVACY_ADDRESS` | found | a text has what may be an e-mail address |\n"
    "| 604 | `PRIVACY_NUMBER` | found | a text has what may be an identification number |\n"
    "| 605 | `PRIVACY_NAME` | found | a text has what may be the name or title of a person |\n"
    "| 651 | `CLOSED_EDGE` | found | the surface of the case stands across an edge between a node "
    "and "
    "its parent, or a root is outside of it: no tool can be pushed there along the tree; found is "
    "the length beyond that cannot be reached, in mm |\n"
    "| 652 | `SURFACE` |  | with `--surface`: the closed surface that `lumen convert` makes leaves "
    "a "
    "part of the case out, was opened or cut, or passes through itself, and the message is that of "
    "`lumen convert`; or, as information, the case has no models |\n"
    "| 653 | `SEEDS` |  | the seeds that the case holds cannot be read: they break a rule of the "
    "[seeds format](seeds.md) |\n";

}  // namespace

std::string readText(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string errorsPage() {
  std::string text =
      "# Errors of the lumen case format\n\n"
      "Made from `formats/container/error_code.cpp`; see [the specification](lumen.md#errors).\n"
      "Numbers and names are stable and are never used again for another rule. A file with an "
      "error is\n"
      "refused; warnings and information do not change that. Numbers from 601 to 700 are for\n"
      "programs' own findings, which are no breach of the format; [below](#findings) are those of\n"
      "`lumen validate`.\n\n"
      "| number | code | severity | arguments | meaning |\n|---|---|---|---|---|\n";
  for (const ErrorRule& rule : errorRules())
    text += "| " + std::to_string(static_cast<int>(rule.code)) + " | `" + rule.name + "` | " +
            severityName(rule.severity) + " | " + rule.arguments + " | " + rule.meaning + " |\n";
  return text + kFindings;
}

std::string propertyTables(const fs::path& folder) {
  std::map<std::string, Json> all;
  for (const char* name : kSchemas)
    all[name] = Json::parse(readText(folder / (std::string(name) + ".schema.json")));
  std::string text;
  for (const char* name : kSchemas) text += table(name, all);
  return text;
}

std::string specificationWithTables(const std::string& text, const std::string& tables) {
  const std::size_t begin = text.find(kBegin), end = text.find(kEnd);
  if (begin == std::string::npos || end == std::string::npos) return "";
  return text.substr(0, begin) + kBegin + "\n" + tables + text.substr(end);
}

std::vector<Requirement> requirements(const std::string& specification) {
  std::vector<Requirement> found;
  const std::string flat =
      std::regex_replace(specification, std::regex("\n(?![\n|#-])  *|\n(?=[^\n|#-])"), " ");
  for (std::sregex_iterator it(flat.begin(), flat.end(), kNumber), end; it != end; ++it) {
    const auto at = static_cast<std::size_t>(it->position());
    std::size_t start = flat.find_last_of("\n", at);
    for (const char* stop : {". ", "]. ", "; ", "]: "})
      if (const auto p = flat.rfind(stop, at); p != std::string::npos && p + 2 > start + 1)
        start = std::max(start, p + std::string(stop).size() - 1);
    std::string sentence = flat.substr(start + 1, at - start - 1);
    while (!sentence.empty() && (sentence.back() == ' ' || sentence.back() == ','))
      sentence.pop_back();
    sentence = std::regex_replace(sentence, std::regex("^[- ]+|\\*\\*|^and |\\|"), "");
    found.push_back({(*it)[1], sentence});
  }
  std::sort(found.begin(), found.end(), [](const Requirement& a, const Requirement& b) {
    return numberOf(a.number) < numberOf(b.number);
  });
  return found;
}

std::vector<TestReference> testReferences(const fs::path& testFolder) {
  const std::regex comment("(?://|#) spec: ([M0-9, ]+)");
  const std::regex name("(?:TEST|TEST_F|TEST_P)\\((\\w+), *(\\w+)\\)|def (test\\w*)");
  std::vector<TestReference> found;
  for (const fs::path& file : sources(testFolder)) {
    const std::string text = readText(file);
    for (std::sregex_iterator it(text.begin(), text.end(), comment), end; it != end; ++it) {
      const std::string rest = text.substr(static_cast<std::size_t>(it->position()));
      std::smatch test;
      if (!std::regex_search(rest, test, name)) continue;
      const std::string full =
          test[1].matched ? test[1].str() + "." + test[2].str() : test[3].str();
      const std::string numbers = (*it)[1];
      const std::regex number("M[0-9]+");
      for (std::sregex_iterator n(numbers.begin(), numbers.end(), number); n != end; ++n)
        found.push_back({full, n->str()});
    }
  }
  return found;
}

std::string coveragePage(const std::string& specification, const fs::path& testFolder) {
  std::map<std::string, std::set<std::string>> tests;
  for (const TestReference& reference : testReferences(testFolder))
    tests[reference.number].insert(reference.test);
  std::string text =
      "# Tests of the specification\n\n"
      "Made from the numbers in [the specification](lumen.md) and the comments `spec: M12` above "
      "tests.\n\n## Requirements\n\n| | requirement | tests |\n|---|---|---|\n";
  for (const Requirement& requirement : requirements(specification)) {
    std::string names;
    for (const std::string& test : tests[requirement.number])
      names += (names.empty() ? "`" : ", `") + test + "`";
    text += "| " + requirement.number + " | " + requirement.sentence + " | " + names + " |\n";
  }
  std::map<std::string, std::string> texts;
  for (const fs::path& file : sources(testFolder / "unit" / "formats"))
    texts[file.filename().string()] = readText(file);
  text += "\n## Error codes\n\n| code | files in tests/unit/formats that provoke it |\n|---|---|\n";
  for (const ErrorRule& rule : errorRules())
    text += "| `" + std::string(rule.name) + "` | " + filesWith(rule.name, texts) + " |\n";
  return text;
}

}  // namespace lumen::formats::test
