// SPDX-License-Identifier: Apache-2.0
// The word by which messages name a field of options.
#pragma once

#include <concepts>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace lumen {

/// "seeds", "root[2]".
inline std::string plainFieldWord(std::string_view field, std::optional<std::size_t> value) {
  std::string word(field);
  if (value) word.append("[").append(std::to_string(*value)).append("]");
  return word;
}

/// The word for a field of options, or for one of its values, counted from 0. A field is named as
/// its option: "seeds", "root", "cell". Stages that name fields in messages hold one among their
/// options; the caller, who knows what people call a field, may set another.
class FieldWord {
public:
  using Function = std::function<std::string(std::string_view, std::optional<std::size_t>)>;

  FieldWord() = default;
  template <class Word>
  requires std::convertible_to<Word, Function> FieldWord(Word word) : m_word(std::move(word)) {}

  std::string operator()(std::string_view field, std::optional<std::size_t> value = {}) const {
    return m_word(field, value);
  }

private:
  Function m_word = plainFieldWord;
};

}  // namespace lumen
