// SPDX-License-Identifier: Apache-2.0
// What options of all stages have in common: help groups, lengths, words.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "converters/base/suggestion.h"
#include "converters/cli/value_checks.h"

namespace lumen::app {

/// mm, a kilometre: nothing in a body is as long.
constexpr double kLongest = 1e6;
inline const CLI::Validator kPositive = numberIn({0, kLongest, true});
inline const CLI::Validator kNotNegative = numberIn({0, kLongest});

template <class T>
std::vector<std::string> namesOf(const std::map<std::string, T>& named) {
  std::vector<std::string> words;
  for (const auto& [word, value] : named) words.push_back(word);
  return words;
}

/// Adds options of one help group whose defaults are the values that the variables hold.
class OptionGroup {
public:
  OptionGroup(CLI::App& app, std::string title) : m_app(app), m_title(std::move(title)) {}

  template <class T>
  CLI::Option* add(const std::string& name, T& value, const std::string& type,
                   const std::string& help) {
    return m_app.add_option(name, value, help)
        ->type_name(type)
        ->group(m_title)
        ->capture_default_str();
  }
  /// A length that follows the voxel size unless it is given.
  CLI::Option* addScaled(const std::string& name, std::optional<double>& value,
                         const std::string& help, const std::string& defaultText) {
    return m_app.add_option(name, value, help + " [" + defaultText + "]")
        ->type_name("MM")
        ->group(m_title)
        ->check(kPositive);
  }
  CLI::Option* addFlag(const std::string& name, bool& value, const std::string& help) {
    return m_app.add_flag(name, value, help)->group(m_title);
  }
  /// One of the words of `named`, of which the value that the variable holds is the default.
  template <class T>
  CLI::Option* addChoice(const std::string& name, T& value, const std::map<std::string, T>& named,
                         const std::string& help) {
    std::string word;
    for (const auto& [known, meaning] : named)
      if (meaning == value) word = known;
    return m_app
        .add_option_function<std::string>(
            name, [&value, &named](const std::string& found) { value = named.at(found); },
            help + ": " + alternatives(namesOf(named)))
        ->type_name("WORD")
        ->group(m_title)
        ->default_str(word)
        ->check(oneOf(namesOf(named)));
  }

private:
  CLI::App& m_app;
  std::string m_title;
};

}  // namespace lumen::app
