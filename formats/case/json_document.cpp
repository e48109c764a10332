// SPDX-License-Identifier: Apache-2.0
#include "formats/case/json_document.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "formats/view/limits.h"
#include "formats/view/text_rules.h"

namespace lumen::formats {
namespace {

using nlohmann::json;
using PairArray = std::vector<std::array<std::uint32_t, 2>>*;

// Numbers below the smallest float become zero; those above the largest have no float.
std::optional<float> floatFromText(std::string_view text, double value) {
  if (std::abs(value) > double{std::numeric_limits<float>::max()} * (1.0 + 0x1.0p-25))
    return std::nullopt;
  float result = 0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), result);
  if (parsed.ec == std::errc{} && std::isfinite(result)) return result;
  return static_cast<float>(value);
}

// Cut short, and free of control characters that the file may have put into it.
std::string printable(std::string_view text) {
  std::string clean;
  for (const char c : text.substr(0, 160)) clean += c >= 0x20 && c < 0x7f ? c : '?';
  return clean;
}

// What the library says, without its prefix.
std::string parserMessage(std::string_view what) {
  if (const auto at = what.find("] "); at != std::string_view::npos) what.remove_prefix(at + 2);
  return printable(what);
}

// Receives nlohmann's parse events; a callback that returns false ends the parse, m_error says why.
class DocumentBuilder {
public:
  DocumentBuilder(std::size_t byteOffset, const std::string& root, ArraySlots& slots)
      : m_byteOffset(byteOffset), m_rootPlace(root), m_slots(slots) {}

  bool null() { return scalar(nullptr); }
  bool boolean(bool value) { return scalar(value); }
  bool string(std::string& value) { return scalar(std::move(value)); }
  bool binary(json::binary_t&) { return false; }  // JSON text has none

  bool number_integer(std::int64_t value) {
    if (m_array) return addInteger(value);
    return scalar(value);
  }
  bool number_unsigned(std::uint64_t value) {
    if (value <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
      return number_integer(static_cast<std::int64_t>(value));
    if (m_array) return addReal(static_cast<double>(value), std::to_string(value));
    return fail(ErrorCode::NumberRange,
                "the integer " + std::to_string(value) + " does not fit into 64 bits with a sign");
  }
  bool number_float(double value, const std::string& text) {
    if (m_array) return addReal(value, text);
    if (text.find_first_of(".eE") == std::string::npos)
      return fail(ErrorCode::NumberRange, "an integer does not fit into 64 bits with a sign");
    return scalar(value);
  }

  bool start_object(std::size_t) {
    if (m_array) return fail(ErrorCode::JsonType, "found an object among numbers");
    return open(json::object());
  }
  bool end_object() { return close(); }

  bool key(std::string& name) {
    Level& level = m_levels.back();
    level.key = name;
    if (level.keys.insert(name).second) return true;
    return fail(ErrorCode::JsonDuplicateKey,
                "the key \"" + printable(name) + "\" occurs twice in its object");
  }

  bool start_array(std::size_t) {
    if (m_array) return startVector();
    if (ArraySlot* slot = slotHere()) {
      slot->seen = true;
      m_array = slot->target;
      m_index = 0;
      return true;
    }
    return open(json::array());
  }

  bool end_array() {
    if (!m_array) return close();
    if (m_component < 0) {
      m_array.reset();
      return true;
    }
    if (m_component != vectorSize())
      return fail(ErrorCode::JsonType, "expected an array of " + std::to_string(vectorSize()));
    m_component = -1;
    ++m_index;
    return true;
  }

  bool parse_error(std::size_t position, const std::string&, const json::exception& error) {
    const bool range = error.id == 406;  // a number beyond the range of a double
    m_error = {range ? ErrorCode::NumberRange : ErrorCode::JsonSyntax, m_byteOffset + position,
               parserMessage(error.what())};
    return false;
  }

  [[nodiscard]] std::optional<json> result(IssueList& issues) {
    if (!m_error) return std::move(m_root);
    issues.add(*std::move(m_error));
    return std::nullopt;
  }

private:
  // An open object or array.
  struct Level {
    json* value;
    std::string key;             // of the member being read, in an object
    std::set<std::string> keys;  // so far, in an object
  };

  // The pointer to the value being read. The innermost array does not hold it yet, so its index is
  // that array's size; every array further out already holds the one within it.
  [[nodiscard]] std::string place() const {
    std::string pointer = m_rootPlace;
    const auto add = [&pointer](const std::string& token) { (pointer += '/') += token; };
    for (const Level& level : m_levels) {
      const std::size_t size = level.value->size();
      add(level.value->is_object()     ? jsonPointerToken(level.key)
          : &level == &m_levels.back() ? std::to_string(size)
                                       : std::to_string(size - 1));
    }
    if (m_array) add(std::to_string(m_index));
    if (m_component >= 0) add(std::to_string(m_component));
    return pointer;
  }

  bool fail(ErrorCode code, const std::string& message, std::vector<Argument> arguments = {}) {
    m_error = pointerIssue(code, place(), message, std::move(arguments));
    return false;
  }

  // The long array that the next value should be, if it is one.
  ArraySlot* slotHere() {
    if (m_slots.byPointer.empty() || m_levels.size() != 2 || !m_levels[0].value->is_object() ||
        !m_levels[1].value->is_object())
      return nullptr;
    if (m_levels[0].key == "nodeArrays") {
      m_nodeArray.target = &m_slots.nodeArrays[m_levels[1].key];
      return &m_nodeArray;
    }
    const auto found = m_slots.byPointer.find("/" + m_levels[0].key + "/" + m_levels[1].key);
    return found == m_slots.byPointer.end() ? nullptr : &found->second;
  }

  // How many numbers an element of the long array has; 0 if they are not in arrays of their own.
  [[nodiscard]] int vectorSize() const {
    if (std::holds_alternative<std::vector<Vec3f>*>(*m_array)) return 3;
    return std::holds_alternative<PairArray>(*m_array) ? 2 : 0;
  }

  json* attach(json value) {
    if (m_levels.empty()) {
      m_root = std::move(value);
      return &m_root;
    }
    Level& level = m_levels.back();
    if (level.value->is_object())
      return &level.value->emplace(level.key, std::move(value)).first.value();
    level.value->push_back(std::move(value));
    return &level.value->back();
  }

  bool scalar(json value) {
    if (m_array)
      return fail(ErrorCode::JsonType,
                  std::string("found ") + value.type_name() + ", expected a number");
    if (slotHere() != nullptr)
      return fail(ErrorCode::JsonType,
                  std::string("found ") + value.type_name() + ", expected an array");
    attach(std::move(value));
    return true;
  }

  bool open(json value) {
    if (m_levels.size() >= kMaxJsonDepth)
      return fail(ErrorCode::JsonDepth, "arrays and objects are nested deeper than " +
                                            std::to_string(kMaxJsonDepth) + " levels");
    if (slotHere() != nullptr)
      return fail(ErrorCode::JsonType, "found an object, expected an array");
    m_levels.push_back({attach(std::move(value)), {}, {}});
    return true;
  }

  bool close() {
    m_levels.pop_back();
    return true;
  }

  bool startVector() {
    if (vectorSize() == 0 || m_component >= 0)
      return fail(ErrorCode::JsonType, "found an array, expected a number");
    if (const auto* vectors = std::get_if<std::vector<Vec3f>*>(&*m_array))
      (*vectors)->emplace_back();
    else
      std::get<PairArray>(*m_array)->emplace_back();
    m_component = 0;
    return true;
  }

  // A number may come next in an array of arrays.
  bool checkComponent() {
    if (m_component >= 0 && m_component < vectorSize()) return true;
    return fail(ErrorCode::JsonType,
                "found a number, expected arrays of " + std::to_string(vectorSize()));
  }

  bool addFloat(float value) {
    if (auto* floats = std::get_if<std::vector<float>*>(&*m_array)) {
      (*floats)->push_back(value);
      ++m_index;
      return true;
    }
    if (!checkComponent()) return false;
    Vec3f& vector = std::get<std::vector<Vec3f>*>(*m_array)->back();
    (m_component == 0 ? vector.x : m_component == 1 ? vector.y : vector.z) = value;
    ++m_component;
    return true;
  }

  bool addDouble(double value) {
    std::get<std::vector<double>*>(*m_array)->push_back(value);
    ++m_index;
    return true;
  }

  [[nodiscard]] bool wantsDoubles() const {
    return std::holds_alternative<std::vector<double>*>(*m_array);
  }
  [[nodiscard]] bool wantsIntegers() const {
    return !wantsDoubles() && !std::holds_alternative<std::vector<float>*>(*m_array) &&
           !std::holds_alternative<std::vector<Vec3f>*>(*m_array);
  }

  bool addReal(double value, const std::string& text) {
    const std::string found = text.substr(0, 40);
    if (wantsDoubles()) return addDouble(value);
    if (wantsIntegers())
      return fail(ErrorCode::JsonType, "found " + found + ", expected an integer",
                  {{"found", found}, {"expected", "an integer"}});
    if (const auto number = floatFromText(text, value)) return addFloat(*number);
    return fail(ErrorCode::NumberRange, "found " + found + ", beyond the range of a float",
                {{"found", found}});
  }

  template <class Integer>
  bool checkRange(std::int64_t value) {
    if (std::in_range<Integer>(value)) return true;
    return fail(ErrorCode::NumberRange,
                "found " + std::to_string(value) + ", expected an integer from " +
                    std::to_string(std::numeric_limits<Integer>::min()) + " to " +
                    std::to_string(std::numeric_limits<Integer>::max()),
                {{"found", std::to_string(value)}});
  }

  template <class Integer>
  bool addTo(std::vector<Integer>& to, std::int64_t value) {
    if (!checkRange<Integer>(value)) return false;
    to.push_back(static_cast<Integer>(value));
    ++m_index;
    return true;
  }

  bool addToPair(std::int64_t value) {
    if (!checkComponent() || !checkRange<std::uint32_t>(value)) return false;
    auto& pair = std::get<PairArray>(*m_array)->back();
    pair[static_cast<std::size_t>(m_component++)] = static_cast<std::uint32_t>(value);
    return true;
  }

  bool addInteger(std::int64_t value) {
    if (wantsDoubles()) return addDouble(static_cast<double>(value));
    if (!wantsIntegers()) return addFloat(static_cast<float>(value));
    if (auto* integers = std::get_if<std::vector<std::int32_t>*>(&*m_array))
      return addTo(**integers, value);
    if (auto* integers = std::get_if<std::vector<std::uint32_t>*>(&*m_array))
      return addTo(**integers, value);
    return addToPair(value);
  }

  std::size_t m_byteOffset;
  std::string m_rootPlace;
  ArraySlots& m_slots;
  json m_root;
  std::vector<Level> m_levels;
  ArraySlot m_nodeArray{};             // the slot of the node array being read
  std::optional<NumberArray> m_array;  // the long array being read
  std::size_t m_index = 0;             // of the element being read in it
  int m_component = -1;                // of the vector being read in it; -1 outside of one
  std::optional<Issue> m_error;
};

std::optional<Issue> checkStart(std::string_view text, std::size_t byteOffset) {
  if (text.starts_with("\xef\xbb\xbf"))
    return Issue{ErrorCode::JsonSyntax, byteOffset,
                 "the text starts with a byte order mark, which JSON does not allow"};
  // the library takes a zero byte for the end of the text
  if (const auto at = text.find('\0'); at != std::string_view::npos)
    return Issue{ErrorCode::JsonSyntax, byteOffset + at, "found a zero byte"};
  return std::nullopt;
}

}  // namespace

std::optional<json> parseJson(std::string_view text, std::size_t byteOffset,
                              const std::string& root, ArraySlots& slots, IssueList& issues) {
  if (auto problem = checkStart(text, byteOffset)) {
    issues.add(*std::move(problem));
    return std::nullopt;
  }
  DocumentBuilder builder(byteOffset, root, slots);
  json::sax_parse(text.begin(), text.end(), &builder);
  return builder.result(issues);
}

float floatFromParsed(double value) {
  const std::string text = shortText(value);
  return floatFromText(text, value).value_or(std::numeric_limits<float>::infinity());
}

}  // namespace lumen::formats
