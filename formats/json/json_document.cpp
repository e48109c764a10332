// SPDX-License-Identifier: Apache-2.0
#include "formats/json/json_document.h"

#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

#include "formats/json/json_number.h"
#include "formats/json/json_text.h"
#include "formats/view/limits.h"
#include "formats/view/text_rules.h"

namespace lumen::formats {
namespace {

using Json = nlohmann::json;
using PairArray = std::vector<std::array<std::uint32_t, 2>>*;

// Builds the values; m_error holds the reason where a function returns false.
class DocumentBuilder final : public JsonEvents {
public:
  DocumentBuilder(std::size_t byteOffset, const std::string& root, ArraySlots& slots)
      : m_byteOffset(byteOffset), m_rootPlace(root), m_slots(slots) {}

  bool null() override { return scalar(nullptr); }
  bool boolean(bool value) override { return scalar(value); }
  bool string(std::string& value) override { return scalar(std::move(value)); }
  bool number(std::string_view text, bool whole) override {
    return m_array ? addNumber(text, whole) : scalar(storedNumber(text, whole));
  }

  bool beginObject() override {
    if (m_array) return wrongType("an object", "a number");
    return open(Json::object());
  }
  bool endObject() override { return close(); }

  bool key(std::string& name) override {
    Level& level = m_levels.back();
    level.key = name;
    if (level.keys.insert(name).second) return true;
    return fail(ErrorCode::JsonDuplicateKey,
                "the key \"" + name.substr(0, 80) + "\" occurs twice in its object",
                {{"key", name.substr(0, 80)}});
  }

  bool beginArray() override {
    if (m_array) return startVector();
    if (ArraySlot* slot = slotHere()) {
      slot->seen = true;
      m_array = slot->target;
      m_index = 0;
      return true;
    }
    return open(Json::array());
  }

  bool endArray() override {
    if (!m_array) return close();
    if (m_component < 0) return m_row ? leaveRow() : leaveArray();
    if (m_component != vectorSize())
      return fail(ErrorCode::JsonType, "expected an array of " + std::to_string(vectorSize()));
    m_component = -1;
    ++m_index;
    return true;
  }

  [[nodiscard]] std::optional<JsonDocument> result(std::optional<JsonFault> fault,
                                                   IssueList& issues) {
    if (fault)
      m_error = Issue{ErrorCode::JsonSyntax, m_byteOffset + fault->at, std::move(fault->message)};
    if (!m_error) return JsonDocument(std::move(m_root));
    issues.add(*std::move(m_error));
    return std::nullopt;
  }

private:
  // An open object or array.
  struct Level {
    Json* value;
    std::string key;             // key of the member being read, in an object
    std::set<std::string> keys;  // keys so far, in an object
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
    if (m_row) add(std::to_string(*m_row));
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

  // Numbers per element of the long array; 0 if elements are no arrays of their own.
  [[nodiscard]] int vectorSize() const {
    if (std::holds_alternative<std::vector<Vec3f>*>(*m_array)) return 3;
    if (const auto* rows = std::get_if<PoseRows*>(&*m_array))
      return (*rows)->width > 1 ? (*rows)->width : 0;
    return std::holds_alternative<PairArray>(*m_array) ? 2 : 0;
  }

  Json* attach(Json value) {
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

  bool scalar(Json value) {
    if (m_array) return wrongType(JsonValue(value).kind(), "a number");
    if (slotHere() != nullptr) return wrongType(JsonValue(value).kind(), "an array");
    attach(std::move(value));
    return true;
  }

  bool open(Json value) {
    if (m_levels.size() >= kMaxJsonDepth)
      return fail(ErrorCode::JsonDepth, "arrays and objects are nested deeper than " +
                                            std::to_string(kMaxJsonDepth) + " levels");
    if (slotHere() != nullptr) return wrongType("an object", "an array");
    m_levels.push_back({attach(std::move(value)), {}, {}});
    return true;
  }

  bool close() {
    m_levels.pop_back();
    return true;
  }

  bool leaveArray() {
    m_array.reset();
    return true;
  }

  bool leaveRow() {
    PoseRows& rows = *std::get<PoseRows*>(*m_array);
    rows.rowEnd.push_back(rows.values.size());
    m_index = *std::exchange(m_row, std::nullopt) + 1;
    return true;
  }

  bool startVector() {
    if (std::holds_alternative<PoseRows*>(*m_array) && !m_row) {
      m_row = std::exchange(m_index, 0);
      return true;
    }
    if (vectorSize() == 0 || m_component >= 0) return wrongType("an array", "a number");
    if (const auto* vectors = std::get_if<std::vector<Vec3f>*>(&*m_array))
      (*vectors)->emplace_back();
    else if (const auto* pairs = std::get_if<PairArray>(&*m_array))
      (*pairs)->emplace_back();
    m_component = 0;
    return true;
  }

  // Whether a number may come next in an array of arrays.
  bool checkComponent() {
    if (m_component >= 0 && m_component < vectorSize()) return true;
    return wrongType("a number", "arrays of " + std::to_string(vectorSize()));
  }

  bool addNumber(std::string_view text, bool whole) {
    if (auto* values = std::get_if<NumberTexts*>(&*m_array)) return addTo(**values, text, whole);
    if (auto* floats = std::get_if<std::vector<float>*>(&*m_array)) return addTo(**floats, text);
    if (auto* vectors = std::get_if<std::vector<Vec3f>*>(&*m_array)) return addTo(**vectors, text);
    if (auto* rows = std::get_if<PoseRows*>(&*m_array)) return addTo(**rows, text);
    if (auto* reals = std::get_if<std::vector<double>*>(&*m_array)) return addTo(**reals, text);
    if (!whole) return wrongType(std::string(text.substr(0, 40)), "an integer");
    if (auto* integers = std::get_if<std::vector<std::int32_t>*>(&*m_array))
      return addTo(**integers, text);
    if (auto* integers = std::get_if<std::vector<std::uint32_t>*>(&*m_array))
      return addTo(**integers, text);
    return addToPair(text);
  }

  // The metadata, which may follow, name the type of these numbers.
  bool addTo(NumberTexts& to, std::string_view text, bool whole) {
    to.add(text, whole);
    ++m_index;
    return true;
  }

  bool addTo(std::vector<float>& to, std::string_view text) {
    const auto value = parseFloat(text);
    if (!value) return false;
    to.push_back(*value);
    ++m_index;
    return true;
  }

  bool addTo(std::vector<Vec3f>& to, std::string_view text) {
    if (!checkComponent()) return false;
    const auto value = parseFloat(text);
    if (!value) return false;
    Vec3f& vector = to.back();
    (m_component == 0 ? vector.x : m_component == 1 ? vector.y : vector.z) = *value;
    ++m_component;
    return true;
  }

  bool addTo(std::vector<double>& to, std::string_view text) {
    const auto value = doubleFromText(text);
    if (!value) return outOfRange(text, "a number that rounds to an f64");
    to.push_back(*value);
    ++m_index;
    return true;
  }

  bool addTo(PoseRows& to, std::string_view text) {
    if (!m_row) return wrongType("a number", "an array for each time");
    if (to.width > 1 && !checkComponent()) return false;
    const auto value = parseFloat(text);
    if (!value) return false;
    to.values.push_back(*value);
    if (to.width > 1)
      ++m_component;
    else
      ++m_index;
    return true;
  }

  template <class Integer>
  bool addTo(std::vector<Integer>& to, std::string_view text) {
    const auto value = whole<Integer>(text);
    if (!value) return false;
    to.push_back(*value);
    ++m_index;
    return true;
  }

  bool addToPair(std::string_view text) {
    if (!checkComponent()) return false;
    const auto value = whole<std::uint32_t>(text);
    if (!value) return false;
    std::get<PairArray>(*m_array)->back()[static_cast<std::size_t>(m_component++)] = *value;
    return true;
  }

  std::optional<float> parseFloat(std::string_view text) {
    const auto value = floatFromText(text);
    if (!value) outOfRange(text, "a number that rounds to an f32");
    return value;
  }

  template <class Integer>
  std::optional<Integer> whole(std::string_view text) {
    const auto value = integerFromText<Integer>(text);
    if (!value)
      outOfRange(text, "an integer from " + std::to_string(std::numeric_limits<Integer>::min()) +
                           " to " + std::to_string(std::numeric_limits<Integer>::max()));
    return value;
  }

  bool wrongType(const std::string& found, const std::string& expected) {
    return fail(ErrorCode::JsonType, "found " + found + ", expected " + expected,
                {{"found", found}, {"expected", expected}});
  }

  bool outOfRange(std::string_view text, const std::string& expected) {
    const std::string found(text.substr(0, 40));
    return fail(ErrorCode::NumberRange, "found " + found + ", expected " + expected,
                {{"found", found}});
  }

  std::size_t m_byteOffset;
  std::string m_rootPlace;
  ArraySlots& m_slots;
  Json m_root;
  std::vector<Level> m_levels;
  ArraySlot m_nodeArray{};             // the slot of the node array being read
  std::optional<NumberArray> m_array;  // the long array being read
  std::optional<std::size_t> m_row;    // row being read in it, if it has rows
  std::size_t m_index = 0;             // index of the element being read in it
  int m_component = -1;                // component of the vector being read; -1 outside of one
  std::optional<Issue> m_error;
};

}  // namespace

void NumberTexts::add(std::string_view text, bool whole) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto single = floatFromText(text);
  double value = doubleFromText(text).value_or(text.starts_with('-') ? -kInfinity : kInfinity);
  // rounding to a double first would give another f32
  if (floatFromDouble(value) != single)
    value = single ? static_cast<double>(*single) : std::copysign(kInfinity, value);
  if (!whole && !firstReal) firstReal = values.size();
  values.push_back(value);
}

std::optional<JsonDocument> parseJson(std::string_view text, std::size_t byteOffset,
                                      const std::string& root, ArraySlots& slots,
                                      IssueList& issues) {
  DocumentBuilder builder(byteOffset, root, slots);
  auto fault = readJsonText(text, builder);
  return builder.result(std::move(fault), issues);
}

std::optional<JsonDocument> parseJson(std::string_view text, std::size_t byteOffset,
                                      const std::string& root, IssueList& issues) {
  ArraySlots none;
  return parseJson(text, byteOffset, root, none, issues);
}

}  // namespace lumen::formats
