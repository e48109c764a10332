// SPDX-License-Identifier: Apache-2.0
#include "converters/cli/value_checks.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iomanip>
#include <optional>
#include <sstream>

#include "converters/base/suggestion.h"

namespace lumen::app {

namespace {

/// All of `text` as a number; a plus may come first.
template <class T>
std::optional<T> parsed(const std::string& text) {
  const std::size_t first = text.size() > 1 && text[0] == '+' && text[1] != '-' ? 1 : 0;
  T value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + first, end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

std::string shortText(double value) {
  std::ostringstream text;
  text << std::setprecision(9) << value;
  return text.str();
}

std::string found(const std::string& text, const std::string& expected) {
  return "found " + (text.empty() ? "nothing" : text) + ", expected " + expected;
}

/// A check without a description: the help says in words what is allowed.
CLI::Validator quietly(std::function<std::string(std::string&)> check) {
  return CLI::Validator(std::move(check), "");
}

/// A whole number as the parser reads it, which takes one with zeros before it for octal.
template <class T>
CLI::Validator whole(T low, T high, const std::string& expected) {
  return quietly([=](std::string& text) -> std::string {
    const auto value = parsed<T>(text);
    if (!value || *value < low || *value > high) return found(text, expected);
    text = std::to_string(*value);
    return {};
  });
}

}  // namespace

bool NumberRange::holds(double value) const {
  return std::isfinite(value) && (openLow ? value > low : value >= low) &&
         (openHigh ? value < high : value <= high);
}

std::string NumberRange::text() const {
  const bool bounded = high != std::numeric_limits<double>::max();
  if (bounded && !openLow && !openHigh)
    return "a number from " + shortText(low) + " to " + shortText(high);
  std::string text =
      "a number " + (openLow ? "above " : std::string("of at least ")) + shortText(low);
  if (bounded) text += (openHigh ? " and below " : " and at most ") + shortText(high);
  return text;
}

CLI::Validator numberIn(const NumberRange& range) {
  return quietly([range](std::string& text) -> std::string {
    const auto value = parsed<double>(text);
    return value && range.holds(*value) ? std::string() : found(text, range.text());
  });
}

CLI::Validator oneOrThreeIn(const NumberRange& range) {
  return quietly([range](std::string& text) -> std::string {
    const auto words = CLI::detail::split(text, ',');
    bool holds = words.size() == 1 || words.size() == 3;
    for (const auto& word : words) {
      const auto value = parsed<double>(word);
      holds = holds && value && range.holds(*value);
    }
    return holds ? std::string()
                 : found(text, range.text() + ", or three with commas between them");
  });
}

CLI::Validator wholeIn(std::int64_t low, std::int64_t high) {
  return whole<std::int64_t>(
      low, high, "a whole number from " + std::to_string(low) + " to " + std::to_string(high));
}

CLI::Validator oneOf(const std::vector<int>& numbers) {
  std::vector<std::string> words;
  for (const int number : numbers) words.push_back(std::to_string(number));
  return quietly([words](std::string& text) -> std::string {
    if (std::find(words.begin(), words.end(), text) != words.end()) return {};
    return found(text, alternatives(words));
  });
}

CLI::Validator oneOf(const std::vector<std::string>& words) {
  return quietly([words](std::string& text) -> std::string {
    if (std::find(words.begin(), words.end(), text) != words.end()) return {};
    return found(text, alternatives(words)) + didYouMean(text, words);
  });
}

CLI::Validator fileName() {
  return quietly([](std::string& text) -> std::string {
    if (text.empty()) return "the name of a file is empty; is a variable of the shell not set?";
    if (text != "-") return {};
    return "found -, expected the name of a file; lumen neither reads standard input nor writes "
           "files to standard output (./- is a file of that name)";
  });
}

CLI::Option* addFile(CLI::App& app, const std::string& name, std::string& file,
                     const std::string& help) {
  CLI::Option* option = app.add_option(name, file, help)->check(fileName());
  if (name.starts_with('-')) return option->type_name("FILE");
  return option->required()->configurable(false);
}

}  // namespace lumen::app
