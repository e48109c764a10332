// SPDX-License-Identifier: Apache-2.0
// Options as rows of data. A row states an option once: name, type, range, default and help;
// command line, configuration file, case record, viewer and lists of cases are made from the rows.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "converters/base/memory_files.h"
#include "converters/base/options/option_value.h"
#include "formats/case/case.h"

namespace lumen {

/// Variable of an option's value. A function receives the texts of all values.
using OptionTarget =
    std::variant<bool*, int*, std::int64_t*, std::uint64_t*, double*, std::optional<std::int64_t>*,
                 std::optional<double>*, std::string*, std::vector<int>*, std::vector<std::string>*,
                 InputFile*, std::vector<InputFile>*, OutputFile*,
                 std::function<void(const std::vector<std::string>&)>>;

/// Kinds of inputs and outputs as sets of bits, defined by the caller of operations.
using ContentMask = std::uint32_t;
constexpr ContentMask kAnyContent = ~ContentMask{0};

/// Another option that a row needs.
struct OptionNeed {
  std::string option;
  std::string word;  ///< the value of it that counts; empty: any
};

/// One option or argument. Texts are for people: help, messages, manual page.
struct OptionRow {
  std::string name;   ///< "inlier-rate"; "CASE" for an argument
  std::string group;  ///< heading in the help; empty: "Options"
  std::string type;   ///< placeholder of the value, "MM"; empty: a flag
  std::string help;
  std::string defaultText;  ///< empty: none is shown
  OptionTarget target;
  MemoryFiles* memory = nullptr;  ///< its files are these where their names are; null: on disk

  bool isArgument = false;  ///< a place instead of a name
  bool isRequired = false;
  std::string recordKey;              ///< key of the value in the record of a case; or empty
  bool repeats = false;               ///< several uses are allowed
  int count = 1;                      ///< number of values, 0 for a flag
  char delimiter = 0;                 ///< separator of values within one text
  std::string alias;                  ///< another spelling, not in the help
  std::string negative;               ///< the name that switches a flag off
  std::vector<std::string> excludes;  ///< names of options that exclude this one

  std::optional<NumberRange> range;
  std::optional<WholeRange> whole;
  std::vector<std::int64_t> numbers;  ///< the only numbers allowed
  std::vector<std::string> words;     ///< the only words allowed
  ValueCheck check;                   ///< check of any other text
  std::function<std::string()> word;  ///< the word of a choice's current value

  ContentMask inputs = kAnyContent;     ///< inputs for which it counts
  ContentMask outputs = kAnyContent;    ///< outputs for which it counts
  std::vector<OptionNeed> needs;        ///< without any of these options it does nothing
  std::vector<std::string> unusedWith;  ///< names of options beside which it does nothing
  /// The reason why its value does nothing beside the values of other rows, as the end of a
  /// sentence; empty if it counts.
  std::function<std::string()> unused;

  bool isGiven = false;                  ///< set() was called
  bool isPreference = false;             ///< a configuration file states the value
  std::vector<std::string> givenValues;  ///< values of the last set()

  [[nodiscard]] bool isFlag() const { return !isArgument && count == 0; }
  /// It is given, and is no flag that is switched off.
  [[nodiscard]] bool isOn() const {
    const auto flag = std::get_if<bool*>(&target);
    return isGiven && (flag == nullptr || **flag);
  }
  /// The name as people write it: "--inlier-rate", "CASE".
  [[nodiscard]] std::string shownName() const { return isArgument ? name : "--" + name; }
  /// The given values with spaces between them, or the default.
  [[nodiscard]] std::string valueText() const;
  /// "found 2, expected a number from 0 to 1", or empty.
  [[nodiscard]] std::string findFault(const std::string& text) const;
  /// Stores the values. Throws Error(Usage) with the option's shown name.
  void set(const std::vector<std::string>& texts);

  // Each of the following returns the row, so that a row reads as one sentence.
  OptionRow& in(NumberRange allowed);
  OptionRow& in(WholeRange allowed);
  OptionRow& among(std::vector<std::int64_t> allowed);
  OptionRow& among(std::vector<std::string> allowed);
  OptionRow& checkedBy(ValueCheck allowed);
  OptionRow& recorded(std::string key = {});  ///< key: its name, or another
  OptionRow& required();
  OptionRow& many();  ///< several uses, or several arguments
  OptionRow& defaults(std::string text);
  OptionRow& without(std::string other);
  OptionRow& inGroup(std::string title);
  OptionRow& alsoCalled(std::string other);
  /// Where it is called several times, one of the options is enough.
  OptionRow& onlyWith(std::string other, std::string value = {});
  OptionRow& notBeside(std::string other);
  OptionRow& unusedIf(std::function<std::string()> reason);
  OptionRow& forInputs(ContentMask mask);
  OptionRow& forOutputs(ContentMask mask);
};

/// Rows whose values are stored in the caller's variables, which must outlive the table. The
/// defaults are the values that the variables hold when a row is added.
class OptionTable {
public:
  OptionTable() = default;
  OptionTable(const OptionTable&) = delete;
  OptionTable& operator=(const OptionTable&) = delete;

  /// Rows that follow belong to this group; empty: "Options".
  void group(std::string title) { m_group = std::move(title); }
  /// Rows that follow count for these inputs and outputs alone.
  void scope(ContentMask inputs, ContentMask outputs = kAnyContent);

  OptionRow& add(std::string name, OptionTarget target, std::string type, std::string help);
  OptionRow& flag(std::string name, bool& value, std::string help);
  /// A length in mm, derived from the data unless it is given; `otherwise` states how.
  OptionRow& scaled(std::string name, std::optional<double>& value, std::string help,
                    const std::string& otherwise);
  /// The name of a file as the value of an option.
  template <class File>
  OptionRow& file(std::string name, File& value, std::string help) {
    return add(std::move(name), &value, "FILE", std::move(help)).checkedBy(fileName());
  }
  /// A required argument; a file unless `check` is another.
  OptionRow& argument(std::string name, OptionTarget target, std::string help,
                      ValueCheck check = fileName());

  /// One of the words of `named`; the default is the variable's current value.
  template <class Value>
  OptionRow& choice(std::string name, Value& value, const std::map<std::string, Value>& named,
                    std::string help) {
    std::vector<std::string> words;
    std::string standard;
    for (const auto& [word, meaning] : named) {
      words.push_back(word);
      if (meaning == value) standard = word;
    }
    const auto store = [&value, &named](const std::vector<std::string>& texts) {
      value = named.at(texts.back());
    };
    OptionRow& row =
        add(std::move(name), OptionTarget(store), "WORD", withWords(std::move(help), words));
    row.word = [&value, &named] {
      for (const auto& [word, meaning] : named)
        if (meaning == value) return word;
      return std::string();
    };
    return row.among(std::move(words)).defaults(std::move(standard));
  }

  [[nodiscard]] const std::deque<OptionRow>& rows() const { return m_rows; }
  [[nodiscard]] std::deque<OptionRow>& rows() { return m_rows; }
  /// The option with the given name or alias (without dashes), or null. An argument is found by its
  /// place alone.
  [[nodiscard]] OptionRow* find(std::string_view name);
  [[nodiscard]] const OptionRow* find(std::string_view name) const;
  /// Throws Error(Usage) if there is no such option, or as OptionRow::set().
  void set(std::string_view name, const std::vector<std::string>& texts);
  /// Throws Error(InvalidInput), which begins with `subject`, if a variable holds what its row does
  /// not allow.
  void requireValues(const std::string& subject) const;

  /// The values of recorded rows that are set, as a step of a case states them.
  [[nodiscard]] std::map<std::string, formats::ParameterValue> recordedValues() const;
  /// Takes the values of recorded rows from a step. A value of another type is ignored.
  void takeRecorded(const formats::Step& step);

private:
  static std::string withWords(std::string help, const std::vector<std::string>& words);

  std::deque<OptionRow> m_rows;  // rows keep their place, as callers hold references
  std::string m_group;
  ContentMask m_inputs = kAnyContent, m_outputs = kAnyContent;
};

}  // namespace lumen
