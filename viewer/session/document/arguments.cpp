// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/document/arguments.h"

#include <cmath>
#include <span>
#include <utility>

#include "converters/base/error.h"
#include "formats/json/json_document.h"

namespace lumen::viewer {

namespace {

constexpr std::size_t kMostText = 255, kMostPoints = 1000, kMostTexts = 10000;
constexpr double kFarthest = 1e6;  // mm; as for seeds files

/// The name of the member that a pointer leads to or into: "position" of "/points/0/position/1".
std::string quotedMember(std::string_view pointer) {
  for (;;) {
    const std::size_t slash = pointer.rfind('/');
    const std::string_view token = pointer.substr(slash + 1);
    if (slash == 0 || token.find_first_not_of("0123456789") != token.npos)
      return '"' + std::string(token) + '"';
    pointer = pointer.substr(0, slash);
  }
}

class RequestFaults final : public formats::JsonFaults {
public:
  void wrongType(std::string pointer, formats::JsonValue, const std::string& expected) override {
    refuse(pointer.empty() ? "a request is a JSON object"
                           : quotedMember(pointer) + " must be " + expected);
  }
  void outOfRange(std::string pointer, formats::JsonNumber found,
                  const std::string& expected) override {
    refuse(quotedMember(pointer) + " is " + found.shown() + ", but must be " + expected);
  }
  void missingKey(std::string, std::string_view key) override {
    refuse('"' + std::string(key) + "\" is missing");
  }
};

RequestFaults requestFaults;  // has no state

std::string quoted(const char* name) {
  return '"' + std::string(name) + '"';
}

double finite(double number, const char* name) {
  if (!(std::abs(number) <= kFarthest)) refuse(quoted(name) + " must be at most 1e6 in size");
  return number;
}

std::string textOf(const formats::JsonPlace& place, const char* name) {
  const std::string& text = *place.text("a text");
  if (text.size() > kMostText) refuse(quoted(name) + " must have at most 255 bytes");
  return text;
}

}  // namespace

void refuse(const std::string& sentence) {
  throw Error(ErrorKind::Usage, sentence);
}

Arguments::Arguments(formats::JsonValue object) : m_object(object, requestFaults) {
  if (!object.isObject()) refuse("a request is a JSON object");
}

bool Arguments::has(const char* name) const {
  const auto found = m_object.find(name);
  return found && !found->value().isNull();
}

formats::JsonPlace Arguments::at(const char* name) const {
  if (!has(name)) refuse(quoted(name) + " is missing");
  return *m_object.find(name);
}

std::int64_t Arguments::whole(const char* name) const {
  return at(name).integer<std::int64_t>("a whole number");
}

std::uint32_t Arguments::index(const char* name, std::size_t count) const {
  const std::int64_t value = whole(name);
  if (value < 0 || static_cast<std::uint64_t>(value) >= count)
    refuse(quoted(name) + " is " + std::to_string(value) + ", but must be below " +
           std::to_string(count));
  return static_cast<std::uint32_t>(value);
}

double Arguments::number(const char* name) const {
  return finite(at(name).real(), name);
}

std::string Arguments::text(const char* name) const {
  return textOf(at(name), name);
}

std::string Arguments::text(const char* name, const std::string& otherwise) const {
  return has(name) ? text(name) : otherwise;
}

bool Arguments::flag(const char* name) const {
  if (!has(name)) return false;
  return at(name).boolean("true or false");
}

Eigen::Vector3d Arguments::position(const char* name) const {
  Eigen::Vector3d position;
  at(name).reals(std::span(position.data(), 3), "three numbers");
  for (const double coordinate : position) finite(coordinate, name);
  return position;
}

std::vector<std::string> Arguments::texts(const char* name) const {
  const auto list = at(name).entries("a list of texts");
  if (list.size() > kMostTexts) refuse(quoted(name) + " must be a list of texts");
  std::vector<std::string> texts;
  for (const formats::JsonPlace& entry : list) texts.push_back(textOf(entry, name));
  return texts;
}

std::vector<convert::SeedPoint> Arguments::points(const char* name) const {
  const std::string expected = "a list of one to 1000 points";
  const auto list = at(name).entries(expected);
  if (list.empty() || list.size() > kMostPoints) refuse(quoted(name) + " must be " + expected);
  std::vector<convert::SeedPoint> points;
  for (const formats::JsonPlace& entry : list) {
    const Arguments members(entry.value());
    convert::SeedPoint point;
    point.position = members.position("position");
    if (members.has("radius_mm")) {
      point.radius = members.number("radius_mm");
      if (!(*point.radius > 0)) refuse("\"radius_mm\" must be above 0");
    }
    points.push_back(point);
  }
  return points;
}

formats::JsonDocument parseRequest(const std::string& text, std::size_t mostBytes) {
  if (text.size() > mostBytes)
    refuse("a request has at most " + std::to_string(mostBytes) + " bytes");
  formats::IssueList issues(1);
  auto document = formats::parseJson(text, 0, "", issues);
  if (!document) refuse("this is not JSON");
  return *std::move(document);
}

}  // namespace lumen::viewer
