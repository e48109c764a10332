// SPDX-License-Identifier: Apache-2.0
#include "converters/api/options.h"

#include <algorithm>
#include <utility>
#include <variant>
#include <vector>

#include "converters/api/handle.h"
#include "converters/base/error.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/scope.h"
#include "converters/io/labels/label_table.h"

namespace lumen::engine::api {
namespace {

bool isOfName(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
}

std::string nameInC(std::string_view option) {
  for (const InputPart& part : kInputParts)
    if (option == part.option) return part.name;
  return '"' + std::string(option) + '"';
}

/// Whether an option allows what no call of this interface does: to open a file.
bool opensFile(std::string_view option) {
  return option == "allow-detached" || option == "native";
}

/// The field of the inputs that takes the place of an option; null if the value names no file.
const InputPart* partInPlaceOf(std::string_view option, std::string_view value) {
  const std::vector<std::string>& tables = convert::builtInLabelTables();
  if (option == "label-table" && std::find(tables.begin(), tables.end(), value) != tables.end())
    return nullptr;
  for (const InputPart& part : kInputParts)
    if (option == part.option) return &part;
  return nullptr;
}

/// Whether an option counts for bytes or arrays, and can be set.
bool isOffered(const OptionRow& row) {
  const std::string& noFile = convert::builtInLabelTables().front();
  return (row.inputs & ~kDicom) != 0 && !opensFile(row.name) &&
         partInPlaceOf(row.name, noFile) == nullptr;
}

void setOption(OptionTable& table, const std::string& name, const std::string& value) {
  if (name.empty()) throw Error(ErrorKind::Usage, "the name of an option is empty");
  if (name.front() == '-')
    throw Error(ErrorKind::Usage,
                "the name of an option begins with a hyphen; expected it "
                "without any, such as \"accuracy\"");
  const InputPart* const part = partInPlaceOf(name, value);
  if (part != nullptr || opensFile(name))
    throw Error(ErrorKind::Usage,
                '"' + name + "\" names a file, and this interface opens none" +
                    (part != nullptr ? std::string("; expected its bytes as ") + part->name : ""));
  std::vector<std::string> values;
  if (const OptionRow* row = table.find(name); row != nullptr && row->repeats)
    values = row->givenValues;
  values.push_back(value);
  table.set(name, values);
}

std::string listOf(const OptionTable& table) {
  Json list = Json::array();
  for (const OptionRow& row : table.rows())
    if (isOffered(row))
      list.push_back({{"name", row.name},
                      {"group", row.group},
                      {"value", row.type},
                      {"default", row.defaultText},
                      {"help", inWordsOfC(row.help)}});
  return list.dump(2);
}

}  // namespace

std::string inWordsOfC(std::string_view sentence) {
  std::string text;
  for (std::size_t at = 0; at < sentence.size();) {
    std::size_t end = at;
    while (end < sentence.size() && isOfName(sentence[end])) ++end;
    const std::string_view word = sentence.substr(at, end - at);
    const bool isOption = word.size() > 2 && word.starts_with("--") && word[2] != '-';
    text += isOption ? nameInC(word.substr(2)) : std::string(word);
    at = end;
    while (at < sentence.size() && !isOfName(sentence[at])) text += sentence[at++];
  }
  return text;
}

Options::Options(const lumen_engine_options* given) {
  if (!given) return;
  for (const OptionRow& row : given->table.rows())
    if (row.isGiven) m_held.table.set(row.name, row.givenValues);
}

void Options::give(const char* option, const InputFile& file) {
  OptionRow& row = *m_held.table.find(option);
  row.set({file.name()});
  if (const auto several = std::get_if<std::vector<InputFile>*>(&row.target))
    **several = {file};
  else
    *std::get<InputFile*>(row.target) = file;
}

operations::Context Options::context(Progress& progress) const {
  return {progress, optionWord(&m_held.table), "the answer of lumen convert"};
}

}  // namespace lumen::engine::api

using namespace lumen::engine::api;

extern "C" {

lumen_engine_status lumen_engine_create_options(lumen_engine_options** out,
                                                lumen_engine_fault* fault) noexcept {
  if (out) *out = nullptr;
  return guarded(fault, [&] {
    requireGiven("lumen_engine_create_options", {{"out", out}});
    *out = new lumen_engine_options;
  });
}

void lumen_engine_free_options(lumen_engine_options* options) noexcept {
  delete options;
}

lumen_engine_status lumen_engine_set_option(lumen_engine_options* options, const char* name,
                                            const char* value, lumen_engine_fault* fault) noexcept {
  return guarded(fault, [&] {
    requireGiven("lumen_engine_set_option",
                 {{"options", options}, {"name", name}, {"value", value}});
    setOption(options->table, name, value);
  });
}

lumen_engine_status lumen_engine_list_options(lumen_engine_bytes** out,
                                              lumen_engine_fault* fault) noexcept {
  if (out) *out = nullptr;
  return guarded(fault, [&] {
    requireGiven("lumen_engine_list_options", {{"out", out}});
    *out = new lumen_engine_bytes{listOf(lumen_engine_options().table)};
  });
}

}  // extern "C"
