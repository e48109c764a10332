// SPDX-License-Identifier: Apache-2.0
#include "converters/base/options/option_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/text.h"

namespace lumen {

namespace {

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

/// The whole text as a number; a plus may come first.
template <class Number>
std::optional<Number> numberIn(const std::string& text) {
  const std::size_t first = text.size() > 1 && text[0] == '+' && text[1] != '-' ? 1 : 0;
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + first, end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

std::vector<std::string> textsOf(const std::vector<std::int64_t>& numbers) {
  std::vector<std::string> texts;
  for (const std::int64_t number : numbers) texts.push_back(std::to_string(number));
  return texts;
}

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::vector<std::string> splitAt(const std::string& text, char delimiter) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(delimiter, at), text.size());
    parts.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return parts;
}

std::string defaultOf(const OptionTarget& target) {
  return std::visit(Overloaded{[](int* value) { return std::to_string(*value); },
                               [](std::int64_t* value) { return std::to_string(*value); },
                               [](std::uint64_t* value) { return std::to_string(*value); },
                               [](double* value) { return numberText(*value); },
                               [](std::string* value) { return *value; },
                               [](const auto&) { return std::string(); }},
                    target);
}

bool isTrue(const std::string& text) {
  return text == "true" || text == "yes" || text == "on" || text == "1";
}

bool isFalse(const std::string& text) {
  return text == "false" || text == "no" || text == "off" || text == "0";
}

/// Writes checked texts into the variable of the row.
void store(const OptionRow& row, const std::vector<std::string>& texts) {
  const std::string& last = texts.back();
  const auto input = [&row](const std::string& name) {
    return row.memory ? row.memory->input(name) : InputFile(name);
  };
  std::visit(
      Overloaded{[&](bool* value) { *value = isTrue(last); },
                 [&](int* value) { *value = numberIn<int>(last).value_or(*value); },
                 [&](std::int64_t* value) { *value = numberIn<std::int64_t>(last).value_or(0); },
                 [&](std::uint64_t* value) { *value = numberIn<std::uint64_t>(last).value_or(0); },
                 [&](double* value) { *value = numberIn<double>(last).value_or(*value); },
                 [&](std::optional<std::int64_t>* value) { *value = numberIn<std::int64_t>(last); },
                 [&](std::optional<double>* value) { *value = numberIn<double>(last); },
                 [&](std::string* value) { *value = last; },
                 [&](std::vector<int>* value) {
                   value->clear();
                   for (const std::string& text : texts)
                     value->push_back(numberIn<int>(text).value_or(0));
                 },
                 [&](std::vector<std::string>* value) { *value = texts; },
                 [&](InputFile* value) { *value = input(last); },
                 [&](std::vector<InputFile>* value) {
                   value->clear();
                   for (const std::string& text : texts) value->push_back(input(text));
                 },
                 [&](OutputFile* value) {
                   *value = row.memory ? row.memory->output(last) : OutputFile(last);
                 },
                 [&](const auto& function) { function(texts); }},
      row.target);
}

/// The number that a variable holds; none for other types, and for unset variables.
std::optional<double> numberOf(const OptionTarget& target) {
  return std::visit(Overloaded{[](int* value) { return std::optional<double>(*value); },
                               [](double* value) { return std::optional(*value); },
                               [](std::optional<double>* value) { return *value; },
                               [](const auto&) { return std::optional<double>(); }},
                    target);
}

std::optional<formats::ParameterValue> parameterOf(const OptionRow& row) {
  using Value = std::optional<formats::ParameterValue>;
  if (row.word) return row.word();
  return std::visit(
      Overloaded{[](bool* value) { return Value(*value); },
                 [](int* value) { return Value(std::int64_t{*value}); },
                 [](std::int64_t* value) { return Value(*value); },
                 [](std::uint64_t* value) { return Value(static_cast<std::int64_t>(*value)); },
                 [](double* value) { return Value(*value); },
                 [](std::string* value) { return Value(*value); },
                 [](std::optional<double>* value) { return *value ? Value(**value) : Value(); },
                 [](const auto&) { return Value(); }},
      row.target);
}

std::optional<double> realIn(const formats::ParameterValue& value) {
  if (const auto* real = std::get_if<double>(&value)) return *real;
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
  return std::nullopt;
}

/// Takes an unchecked value of a file; the user of the value checks its range.
void take(const OptionRow& row, const formats::ParameterValue& found) {
  const auto* whole = std::get_if<std::int64_t>(&found);
  if (const auto* word = std::get_if<std::string>(&found); row.word && word != nullptr)
    return contains(row.words, *word) ? store(row, {*word}) : void();
  std::visit(Overloaded{[&](bool* value) {
                          if (const auto* flag = std::get_if<bool>(&found)) *value = *flag;
                        },
                        [&](int* value) {
                          if (whole && *whole >= 0 && *whole <= INT32_MAX)
                            *value = static_cast<int>(*whole);
                        },
                        [&](std::int64_t* value) { *value = whole ? *whole : *value; },
                        [&](std::uint64_t* value) {
                          if (whole) *value = static_cast<std::uint64_t>(*whole);
                        },
                        [&](double* value) { *value = realIn(found).value_or(*value); },
                        [&](std::optional<double>* value) {
                          if (const auto real = realIn(found); real && !std::isnan(*real))
                            *value = real;
                        },
                        [](const auto&) {}},
             row.target);
}

}  // namespace

std::string OptionRow::findFault(const std::string& text) const {
  if (!words.empty()) return checkAmong(words)(text);
  if (!numbers.empty()) {
    const std::vector<std::string> allowed = textsOf(numbers);
    return contains(allowed, text) ? std::string() : foundText(text, alternatives(allowed));
  }
  if (range) {
    const auto value = numberIn<double>(text);
    return value && range->holds(*value) ? std::string() : foundText(text, range->text());
  }
  if (whole) {
    const auto value = numberIn<std::int64_t>(text);
    const bool holds = value && *value >= whole->low && *value <= whole->high;
    return holds ? std::string() : foundText(text, whole->text());
  }
  if (isFlag() && !isTrue(text) && !isFalse(text)) return foundText(text, "true or false");
  return check ? check(text) : std::string();
}

void OptionRow::set(const std::vector<std::string>& given) {
  std::vector<std::string> texts;
  for (const std::string& text : given)
    for (std::string& part : delimiter == 0 ? std::vector{text} : splitAt(text, delimiter))
      texts.push_back(std::move(part));
  for (const std::string& text : texts)
    if (const std::string fault = findFault(text); !fault.empty())
      throw Error(ErrorKind::Usage, shownName() + ": " + fault);
  if (texts.empty()) throw Error(ErrorKind::Usage, shownName() + " needs a value");
  if (count > 1 && texts.size() != static_cast<std::size_t>(count))
    throw Error(ErrorKind::Usage, shownName() + ": found " + std::to_string(texts.size()) +
                                      (texts.size() == 1 ? " value" : " values") + ", expected " +
                                      type);
  store(*this, texts);
  isGiven = true;
  givenValues = texts;
}

std::string OptionRow::valueText() const {
  if (!isGiven) return defaultText;
  std::string text;
  for (const std::string& value : givenValues) text += (text.empty() ? "" : " ") + value;
  return text;
}

OptionRow& OptionRow::in(NumberRange allowed) {
  range = allowed;
  return *this;
}
OptionRow& OptionRow::in(WholeRange allowed) {
  whole = allowed;
  return *this;
}
OptionRow& OptionRow::among(std::vector<std::int64_t> allowed) {
  numbers = std::move(allowed);
  return *this;
}
OptionRow& OptionRow::among(std::vector<std::string> allowed) {
  words = std::move(allowed);
  return *this;
}
OptionRow& OptionRow::checkedBy(ValueCheck allowed) {
  check = std::move(allowed);
  return *this;
}
OptionRow& OptionRow::recorded(std::string key) {
  recordKey = key.empty() ? name : std::move(key);
  return *this;
}
OptionRow& OptionRow::required() {
  isRequired = true;
  return *this;
}
OptionRow& OptionRow::many() {
  repeats = true;
  return *this;
}
OptionRow& OptionRow::defaults(std::string text) {
  defaultText = std::move(text);
  return *this;
}
OptionRow& OptionRow::without(std::string other) {
  excludes.push_back(std::move(other));
  return *this;
}
OptionRow& OptionRow::inGroup(std::string title) {
  group = std::move(title);
  return *this;
}
OptionRow& OptionRow::alsoCalled(std::string other) {
  alias = std::move(other);
  return *this;
}
OptionRow& OptionRow::onlyWith(std::string other, std::string value) {
  needs.push_back({std::move(other), std::move(value)});
  return *this;
}
OptionRow& OptionRow::notBeside(std::string other) {
  unusedWith.push_back(std::move(other));
  return *this;
}
OptionRow& OptionRow::unusedIf(std::function<std::string()> reason) {
  unused = std::move(reason);
  return *this;
}
OptionRow& OptionRow::forInputs(ContentMask mask) {
  inputs = mask;
  return *this;
}
OptionRow& OptionRow::forOutputs(ContentMask mask) {
  outputs = mask;
  return *this;
}

void OptionTable::scope(ContentMask inputs, ContentMask outputs) {
  m_inputs = inputs;
  m_outputs = outputs;
}

OptionRow& OptionTable::add(std::string name, OptionTarget target, std::string type,
                            std::string help) {
  OptionRow& row = m_rows.emplace_back();
  row.name = std::move(name);
  row.group = m_group;
  row.type = std::move(type);
  row.help = std::move(help);
  row.inputs = m_inputs;
  row.outputs = m_outputs;
  row.defaultText = defaultOf(target);
  row.target = std::move(target);
  return row;
}

OptionRow& OptionTable::flag(std::string name, bool& value, std::string help) {
  OptionRow& row = add(std::move(name), &value, "", std::move(help));
  row.count = 0;
  return row;
}

OptionRow& OptionTable::scaled(std::string name, std::optional<double>& value, std::string help,
                               const std::string& otherwise) {
  return add(std::move(name), &value, "MM", std::move(help) + " [" + otherwise + "]").in(kPositive);
}

OptionRow& OptionTable::argument(std::string name, OptionTarget target, std::string help,
                                 ValueCheck check) {
  OptionRow& row = add(std::move(name), std::move(target), "", std::move(help));
  row.isArgument = true;
  row.isRequired = true;
  row.group.clear();
  row.defaultText.clear();
  row.inputs = row.outputs = kAnyContent;
  return row.checkedBy(std::move(check));
}

OptionRow* OptionTable::find(std::string_view name) {
  for (OptionRow& row : m_rows)
    if (!row.isArgument && (row.name == name || (!row.alias.empty() && row.alias == name)))
      return &row;
  return nullptr;
}

const OptionRow* OptionTable::find(std::string_view name) const {
  for (const OptionRow& row : m_rows)
    if (!row.isArgument && (row.name == name || (!row.alias.empty() && row.alias == name)))
      return &row;
  return nullptr;
}

void OptionTable::set(std::string_view name, const std::vector<std::string>& texts) {
  OptionRow* const row = find(name);
  if (row != nullptr) return row->set(texts);
  std::vector<std::string> names;
  for (const OptionRow& one : m_rows)
    if (!one.isArgument) names.push_back(one.shownName());
  const std::string shown = "--" + std::string(name);
  throw Error(ErrorKind::Usage, shown + ": there is no such option" + didYouMean(shown, names));
}

void OptionTable::requireValues(const std::string& subject) const {
  for (const OptionRow& row : m_rows) {
    const std::optional<double> value = numberOf(row.target);
    if (!value) continue;
    const bool isWhole = std::holds_alternative<int*>(row.target);
    const std::string text =
        isWhole ? std::to_string(static_cast<std::int64_t>(*value)) : numberText(*value);
    std::string fault;
    if (row.range && !row.range->holds(*value)) fault = foundText(text, row.range->text());
    if (isWhole) fault = row.findFault(text);
    if (!fault.empty()) throw invalidInput(subject + row.name + ": " + fault);
  }
}

std::map<std::string, formats::ParameterValue> OptionTable::recordedValues() const {
  std::map<std::string, formats::ParameterValue> values;
  for (const OptionRow& row : m_rows)
    if (!row.recordKey.empty())
      if (auto value = parameterOf(row)) values.emplace(row.recordKey, *std::move(value));
  return values;
}

void OptionTable::takeRecorded(const formats::Step& step) {
  for (const OptionRow& row : m_rows) {
    const auto found = step.parameters.find(row.recordKey);
    if (!row.recordKey.empty() && found != step.parameters.end()) take(row, found->second);
  }
}

std::string OptionTable::withWords(std::string help, const std::vector<std::string>& words) {
  return std::move(help) + ": " + alternatives(words);
}

}  // namespace lumen
