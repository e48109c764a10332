// SPDX-License-Identifier: Apache-2.0
// Declared in centerline_readers.h.
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/number_text.h"
#include "converters/base/options/parsed_number.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/io/centerline/centerline_readers.h"
#include "converters/io/centerline/join_curves.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

constexpr double kLargestTre = 1e9;  // far beyond any plausible length
constexpr std::size_t kMostColumns = 1000;
constexpr std::size_t kTreHead = 256;  // position limit of a comment of write_centerline.cpp
constexpr int kDeepestTree = 1000;

// The placement of an object within its parent.
struct Placement {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
};

struct TreObject {
  std::string type, name;
  int id = -1, parent = -1, parentPoint = -1;
  Eigen::Vector3d spacing = Eigen::Vector3d::Ones();
  Placement placement;
  std::vector<std::string> columns;
  std::optional<std::uint64_t> count;
  bool isBinary = false, isBigEndian = false, isDouble = false;
  bool hasPlainRadii = false;  // spacing applies to places alone
  std::vector<CurvePoint> points;
};

class TreParser {
public:
  TreParser(std::string_view text, std::string name)
      : m_rest(withoutByteOrderMark(text)), m_name(std::move(name)) {}

  // All objects but the scene itself.
  std::vector<TreObject> objects() {
    while (!m_rest.empty()) {
      const std::string line = trimmed(std::string(nextLine()));
      if (line.empty()) continue;
      const auto mark = line.find_first_of("=:");
      if (mark == line.npos) refuse("is " + quotedText(line) + "; expected KEY = VALUE");
      const std::string key = trimmed(line.substr(0, mark)), value = trimmed(line.substr(mark + 1));
      if (line[mark] == ':')
        takeTubeX(key, value);
      else
        take(key, value);
    }
    if (m_objects.empty())
      throw invalidInput(m_name + ": has no ObjectType; expected a scene of tubes");
    return std::move(m_objects);
  }

private:
  void take(const std::string& key, const std::string& value) {
    if (key == "ObjectType") {
      m_objects.emplace_back();
      m_objects.back().type = value;
      return;
    }
    if (m_objects.empty()) {
      if (key == "Comment" || key == "NDims") return;
      refuse("is " + quotedText(key) + "; expected ObjectType first");
    }
    TreObject& object = m_objects.back();
    if (key == "NDims" && value != "3")
      refuse("has " + quotedText(value) + " dimensions; expected 3");
    else if (key == "ID")
      object.id = whole(value);
    else if (key == "ParentPoint")
      object.parentPoint = whole(value);
    else if (key == "ParentID")
      object.parent = whole(value);
    else if (key == "Name")
      object.name = value;
    else if (key == "BinaryData")
      object.isBinary = isTrue(value);
    else if (key == "BinaryDataByteOrderMSB" || key == "ElementByteOrderMSB")
      object.isBigEndian = isTrue(value);
    else if (key == "ElementType")
      takeType(object, value);
    else if (key == "CompressedData" && isTrue(value))
      refuse("states that data are compressed; expected CompressedData = False");
    else if (key == "ElementSpacing")
      object.spacing = parseVector(value);
    else if (key == "Offset" || key == "Position")
      object.placement.offset = parseVector(value);
    else if (key == "TransformMatrix" || key == "Rotation" || key == "Orientation")
      takeMatrix(object, value);
    else if (key == "PointDim")
      takeColumns(object, value);
    else if (key == "NPoints")
      object.count = static_cast<std::uint64_t>(std::max(0, whole(value)));
    else if (key == "Points")
      takePoints(object);
  }

  // A line of TubeX, TubeTK's older style (itktubeTubeXIO.hxx), whose objects begin with ID.
  void takeTubeX(const std::string& key, const std::string& value) {
    if (key == "ID") {
      m_objects.emplace_back();
      m_objects.back().type = "Tube";
      m_objects.back().spacing = m_voxel;
      m_objects.back().hasPlainRadii = true;
      m_objects.back().id = whole(value);
      return;
    }
    if (m_objects.empty()) {
      if (key == "NDims" && value != "3")
        refuse("has " + quotedText(value) + " dimensions; expected 3");
      if (key == "VoxelSize") m_voxel = parseVector(value);
      return;
    }
    TreObject& object = m_objects.back();
    if (key == "Type")
      object.type = value;
    else if (key == "VParent")
      object.parent = whole(value);
    else if (key == "Attachpt")
      object.parentPoint = whole(value);
    else if (key == "PointDim")
      takeColumns(object, std::string_view(value).substr(
                              std::min(value.find_first_not_of("0123456789 "), value.size())));
    else if (key == "NPoints")
      object.count = static_cast<std::uint64_t>(std::max(0, whole(value)));
    else if (key == "Points")
      takePoints(object);
  }

  static bool isTrue(const std::string& value) {
    return value.starts_with('T') || value.starts_with('t') || value.starts_with('1');
  }

  void takeType(TreObject& object, const std::string& value) {
    if (value != "MET_FLOAT" && value != "MET_DOUBLE")
      refuse("has the ElementType " + quotedText(value) + "; expected MET_FLOAT or MET_DOUBLE");
    object.isDouble = value == "MET_DOUBLE";
  }

  void takeMatrix(TreObject& object, const std::string& value) {
    const std::vector<double> numbers = parseNumbers(value);
    if (numbers.size() != 9)
      refuse("has " + std::to_string(numbers.size()) + " numbers; expected 9");
    for (int i = 0; i < 9; ++i) object.placement.matrix(i / 3, i % 3) = numbers[std::size_t(i)];
  }

  void takeColumns(TreObject& object, std::string_view value) {
    object.columns.clear();
    for (std::string_view word; !(word = nextWord(value)).empty();) {
      if (object.columns.size() == kMostColumns) refuse("names more than 1000 columns");
      object.columns.push_back(lowerCase(std::string(word)));
    }
  }

  void takePoints(TreObject& object) {
    if (object.type != "Tube") {
      if (object.isBinary)
        refuse("begins the binary data of " + quotedText(object.type) + "; expected tubes alone");
      return skipLines(object.count.value_or(0));
    }
    if (!object.count) refuse("begins points whose number is unknown; expected NPoints before");
    if (object.columns.empty()) object.columns = {"x", "y", "z", "r"};
    const std::array<std::size_t, 4> place = {column(object, {"x"}), column(object, {"y"}),
                                              column(object, {"z"}),
                                              column(object, {"r", "rad", "radius", "s"})};
    const std::uint64_t width = object.columns.size();
    // a number takes at least a digit and a blank
    const std::uint64_t bytes = object.isBinary ? (object.isDouble ? 8 : 4) : 2;
    if (*object.count > m_rest.size() / width / bytes + 1)
      refuse("begins " + std::to_string(*object.count) + " points of " + std::to_string(width) +
             " numbers, more than the file holds");
    for (std::uint64_t i = 0; i < *object.count; ++i) {
      const std::vector<double> row = object.isBinary ? binaryRow(object) : textRow(width);
      CurvePoint point{{value(row, place[0]), value(row, place[1]), value(row, place[2])}, 0};
      if (place[3] < row.size()) point.radius = std::max(0.0, value(row, place[3]));
      object.points.push_back(point);
    }
  }

  [[nodiscard]] std::size_t column(const TreObject& object,
                                   std::initializer_list<const char*> names) const {
    for (const char* name : names) {
      const auto found = std::find(object.columns.begin(), object.columns.end(), name);
      if (found != object.columns.end())
        return static_cast<std::size_t>(found - object.columns.begin());
    }
    if (*names.begin() == std::string_view("r")) return object.columns.size();
    refuse(std::string("begins points without the column ") + *names.begin() + " in PointDim");
  }

  [[nodiscard]] double value(const std::vector<double>& row, std::size_t place) const {
    if (!(std::abs(row[place]) <= kLargestTre))
      refuse("has the number " + foundNumber(row[place]) + "; expected -1e9 to 1e9");
    return row[place];
  }

  std::vector<double> textRow(std::uint64_t width) {
    std::vector<double> row;
    while (row.size() < width) {
      if (m_rest.empty()) refuse("is the last, but points are missing");
      const std::vector<double> more = parseNumbers(nextLine());
      row.insert(row.end(), more.begin(), more.end());
    }
    if (row.size() != width)
      refuse("has " + std::to_string(row.size()) + " numbers; expected " + std::to_string(width) +
             ", as PointDim");
    return row;
  }

  std::vector<double> binaryRow(const TreObject& object) {
    std::vector<double> row;
    for (std::size_t c = 0; c < object.columns.size(); ++c)
      row.push_back(object.isDouble ? binary<double>(object) : double{binary<float>(object)});
    return row;
  }

  template <class Number>
  Number binary(const TreObject& object) {
    std::array<char, sizeof(Number)> raw;
    if (m_rest.size() < raw.size()) refuse("begins binary points that end too early");
    std::memcpy(raw.data(), m_rest.data(), raw.size());
    m_rest.remove_prefix(raw.size());
    if (object.isBigEndian != (std::endian::native == std::endian::big))
      std::reverse(raw.begin(), raw.end());
    return std::bit_cast<Number>(raw);
  }

  void skipLines(std::uint64_t count) {
    for (; count > 0 && !m_rest.empty(); --count) nextLine();
  }

  std::string_view nextLine() {
    ++m_number;
    const std::size_t end = std::min(m_rest.find('\n'), m_rest.size());
    const std::string_view line = m_rest.substr(0, end);
    m_rest.remove_prefix(std::min(end + 1, m_rest.size()));
    return line;
  }

  static std::string_view nextWord(std::string_view& text) {
    const std::size_t from = std::min(text.find_first_not_of(" \t\r,"), text.size());
    text.remove_prefix(from);
    const std::string_view word =
        text.substr(0, std::min(text.find_first_of(" \t\r,"), text.size()));
    text.remove_prefix(word.size());
    return word;
  }

  [[nodiscard]] std::vector<double> parseNumbers(std::string_view text) const {
    std::vector<double> numbers;
    for (std::string_view word; !(word = nextWord(text)).empty();) {
      const auto value = parsedNumber(word);
      if (!value) refuse("has " + quotedText(std::string(word)) + "; expected a number");
      numbers.push_back(*value);
    }
    return numbers;
  }

  [[nodiscard]] Eigen::Vector3d parseVector(const std::string& text) const {
    const std::vector<double> numbers = parseNumbers(text);
    if (numbers.size() != 3)
      refuse("has " + std::to_string(numbers.size()) + " numbers; expected 3");
    for (const double number : numbers)
      if (!(std::abs(number) <= kLargestTre))
        refuse("has the number " + foundNumber(number) + "; expected -1e9 to 1e9");
    return {numbers[0], numbers[1], numbers[2]};
  }

  [[nodiscard]] int whole(const std::string& text) const {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size())
      refuse("has " + quotedText(text) + "; expected a whole number");
    return value;
  }

  [[noreturn]] void refuse(const std::string& what) const {
    throw invalidInput(m_name + ": line " + std::to_string(m_number) + " " + what);
  }

  std::string_view m_rest;
  std::string m_name;
  std::size_t m_number = 0;
  std::vector<TreObject> m_objects;
  Eigen::Vector3d m_voxel = Eigen::Vector3d::Ones();  // of TubeX
};

// Objects by their ids; the first object wins where ids are equal.
std::map<int, std::size_t> objectsById(const std::vector<TreObject>& objects) {
  std::map<int, std::size_t> byId;
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (objects[i].id >= 0) byId.emplace(objects[i].id, i);
  return byId;
}

// The placement of an object in the scene: its own one, then those of its ancestors.
Placement placementOf(std::size_t object, const std::vector<TreObject>& objects,
                      const std::map<int, std::size_t>& byId) {
  Placement all;
  for (int depth = 0; depth < kDeepestTree; ++depth) {
    const Placement& placement = objects[object].placement;
    all.matrix = placement.matrix * all.matrix;
    all.offset = placement.matrix * all.offset + placement.offset;
    const auto parent = byId.find(objects[object].parent);
    if (parent == byId.end() || parent->second == object) break;
    object = parent->second;
  }
  return all;
}

bool movesNothing(const std::vector<TreObject>& objects) {
  return std::all_of(objects.begin(), objects.end(), [](const TreObject& object) {
    return object.placement.matrix.isIdentity(0) && object.placement.offset.isZero(0);
  });
}

}  // namespace

CenterlineFile parseTre(std::string_view text, const std::string& name) {
  const std::string shown = formats::printable(name);
  const std::vector<TreObject> objects = TreParser(text, shown).objects();
  const std::map<int, std::size_t> byId = objectsById(objects);
  const bool stays = movesNothing(objects);
  std::vector<CenterlineCurve> curves;
  std::vector<std::int32_t> curveOf(objects.size(), -1);
  std::size_t others = 0;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const TreObject& object = objects[i];
    if (object.type != "Tube") others += object.type != "Scene" && object.type != "Group" ? 1 : 0;
    if (object.type != "Tube" || object.points.empty()) continue;
    curveOf[i] = static_cast<std::int32_t>(curves.size());
    curves.push_back({object.name, object.points, -1, -1});
    const Placement placement = stays ? Placement() : placementOf(i, objects, byId);
    const double scale = stays ? 1 : std::cbrt(std::abs(placement.matrix.determinant()));
    for (CurvePoint& point : curves.back().points) {
      point.position = point.position.cwiseProduct(object.spacing);
      if (!stays) point.position = placement.matrix * point.position + placement.offset;
      if (!(point.position.norm() <= kLargestTre * 2) || !(point.radius * scale <= kLargestTre))
        throw invalidInput(shown + ": a point of the tube \"" +
                           formats::printable(object.name.substr(0, 40)) +
                           "\" lies beyond 2e9 mm; expected lengths of vessels");
      if (!object.hasPlainRadii) point.radius *= std::abs(object.spacing.x());
      point.radius *= scale;
    }
  }
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const auto parent = byId.find(objects[i].parent);
    if (curveOf[i] < 0 || parent == byId.end() || parent->second == i) continue;
    CenterlineCurve& curve = curves[std::size_t(curveOf[i])];
    curve.parent = curveOf[parent->second];
    curve.parentPoint = objects[i].parentPoint;
  }
  if (curves.empty())
    throw invalidInput(shown + ": has no tube with points; expected ObjectType = Tube");
  CenterlineFile file = joinCurves(curves);
  file.unit = 1;
  file.axes = CenterlineAxes::Lps;
  file.isOfLumen = text.substr(0, kTreHead).find(kOwnCenterline) != text.npos;
  if (others > 0)
    file.remarks.push_back(std::to_string(others) + " objects that are no tubes are left out");
  fillRadii(file, shown, "the column r of PointDim");
  return file;
}

CenterlineFile readTre(const InputFile& file) {
  return parseTre(file.read("centerline", kMostText), file.path().string());
}

}  // namespace lumen::convert
