// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/arguments.h"

#include <cmath>

#include "converters/base/error.h"

namespace lumen::viewer {

namespace {

constexpr int kDeepest = 8;
constexpr std::size_t kMostText = 255, kMostPoints = 1000, kMostTexts = 10000;
constexpr double kFarthest = 1e6;  // mm; as for seeds files

[[noreturn]] void refuse(const std::string& what) {
  throw Error(ErrorKind::Usage, what);
}

std::string quoted(const char* name) {
  return '"' + std::string(name) + '"';
}

double finite(const Json& value, const char* name) {
  if (!value.is_number()) refuse(quoted(name) + " must be a number");
  const auto number = value.get<double>();
  if (!(std::abs(number) <= kFarthest)) refuse(quoted(name) + " must be at most 1e6 in size");
  return number;
}

Eigen::Vector3d vectorOf(const Json& value, const char* name) {
  if (!value.is_array() || value.size() != 3) refuse(quoted(name) + " must be three numbers");
  return {finite(value[0], name), finite(value[1], name), finite(value[2], name)};
}

std::string textOf(const Json& value, const char* name) {
  if (!value.is_string()) refuse(quoted(name) + " must be a text");
  auto text = value.get<std::string>();
  if (text.size() > kMostText) refuse(quoted(name) + " must have at most 255 bytes");
  return text;
}

}  // namespace

Arguments::Arguments(const Json& object) : m_object(object) {
  if (!object.is_object()) refuse("a request is a JSON object");
}

bool Arguments::has(const char* name) const {
  return m_object.contains(name) && !m_object[name].is_null();
}

const Json& Arguments::at(const char* name) const {
  if (!has(name)) refuse(quoted(name) + " is missing");
  return m_object[name];
}

std::int64_t Arguments::whole(const char* name) const {
  const Json& value = at(name);
  if (!value.is_number_integer()) refuse(quoted(name) + " must be a whole number");
  return value.get<std::int64_t>();
}

std::uint32_t Arguments::index(const char* name, std::size_t count) const {
  const std::int64_t value = whole(name);
  if (value < 0 || static_cast<std::uint64_t>(value) >= count)
    refuse(quoted(name) + " is " + std::to_string(value) + ", but must be below " +
           std::to_string(count));
  return static_cast<std::uint32_t>(value);
}

double Arguments::number(const char* name) const {
  return finite(at(name), name);
}

std::string Arguments::text(const char* name) const {
  return textOf(at(name), name);
}

std::string Arguments::text(const char* name, const std::string& otherwise) const {
  return has(name) ? text(name) : otherwise;
}

bool Arguments::flag(const char* name) const {
  if (!has(name)) return false;
  if (!at(name).is_boolean()) refuse(quoted(name) + " must be true or false");
  return at(name).get<bool>();
}

Eigen::Vector3d Arguments::position(const char* name) const {
  return vectorOf(at(name), name);
}

std::vector<std::string> Arguments::texts(const char* name) const {
  const Json& list = at(name);
  if (!list.is_array() || list.size() > kMostTexts)
    refuse(quoted(name) + " must be a list of texts");
  std::vector<std::string> texts;
  for (const Json& value : list) texts.push_back(textOf(value, name));
  return texts;
}

std::vector<convert::SeedPoint> Arguments::points(const char* name) const {
  const Json& list = at(name);
  if (!list.is_array() || list.empty() || list.size() > kMostPoints)
    refuse(quoted(name) + " must be a list of one to 1000 points");
  std::vector<convert::SeedPoint> points;
  for (const Json& value : list) {
    const Arguments members(value);
    convert::SeedPoint point;
    point.position = members.position("position");
    if (members.has("radius")) {
      point.radius = members.number("radius");
      if (!(*point.radius > 0)) refuse("\"radius\" must be above 0");
    }
    points.push_back(point);
  }
  return points;
}

Json parseRequest(const std::string& text, std::size_t mostBytes) {
  if (text.size() > mostBytes)
    refuse("a request has at most " + std::to_string(mostBytes) + " bytes");
  try {
    return Json::parse(text, [](int depth, Json::parse_event_t, Json&) {
      if (depth > kDeepest) refuse("a request is nested at most eight levels deep");
      return true;
    });
  } catch (const Json::exception&) {
    refuse("this is not JSON");
  }
}

}  // namespace lumen::viewer
