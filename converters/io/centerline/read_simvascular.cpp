// SPDX-License-Identifier: Apache-2.0
// Declared in centerline_readers.h.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numbers>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/options/parsed_number.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/io/centerline/centerline_readers.h"
#include "converters/io/centerline/folder_files.h"
#include "converters/io/centerline/join_curves.h"
#include "converters/io/centerline/tree_of_lines.h"
#include "converters/io/vtk/xml_events.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

constexpr double kLargestSv = 1e9;  // far beyond any plausible length
// Limits of what is compared with one another.
constexpr std::size_t kMostPathPoints = 100000, kMostContours = 10000;
constexpr std::string_view kPath = ".pth", kContours = ".ctgr";

struct SvContour {
  Vector3d onPath = Vector3d::Zero(), centre = Vector3d::Zero();
  double radius = 0;
};

// A path, or the contours of one.
struct SvFile {
  std::string name;      // of the path: that of its file; contours may state none
  std::string id, file;  // the path's number; the file's name
  bool isPath = false;
  std::size_t times = 0;
  std::vector<Vector3d> points;
  std::vector<SvContour> contours;
  std::size_t withoutArea = 0;
};

// A contour of the area within `points` and its middle; empty for one without area.
std::optional<SvContour> contourOf(const std::vector<Vector3d>& points) {
  if (points.size() < 3) return {};
  Vector3d mean = Vector3d::Zero(), normal = Vector3d::Zero(), moment = Vector3d::Zero();
  for (const Vector3d& point : points) mean += point / static_cast<double>(points.size());
  const auto forTriangles = [&](auto take) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vector3d& a = points[i];
      const Vector3d& b = points[(i + 1) % points.size()];
      take(a, b, Vector3d((a - mean).cross(b - mean) / 2));
    }
  };
  forTriangles([&](const Vector3d&, const Vector3d&, const Vector3d& area) { normal += area; });
  const double area = normal.norm();
  if (!(area > 0)) return {};
  forTriangles([&](const Vector3d& a, const Vector3d& b, const Vector3d& part) {
    moment += (a + b + mean) / 3 * (part.dot(normal) / area);
  });
  SvContour contour;
  contour.centre = moment / area;
  contour.radius = std::sqrt(area / std::numbers::pi);
  return contour;
}

// The text with blanks before its last element: SimVascular writes <format/> before it, which no XML
// parser takes for a whole document.
std::string singleElement(std::string_view text) {
  const std::size_t begin = std::min(text.find("<path "), text.find("<contourgroup "));
  std::string single(text);
  if (begin == text.npos) return single;
  std::replace_if(
      single.begin(), single.begin() + static_cast<std::ptrdiff_t>(begin),
      [](char c) { return c != '\n'; }, ' ');
  return single;
}

class SvReader : XmlEvents {
public:
  SvReader(const std::string& text, const std::string& name) : XmlEvents(text, name) {}

  SvFile parse() {
    run("; expected a path (.pth) or contours (.ctgr) of SimVascular");
    if (m_file.points.size() > kMostPathPoints || m_file.contours.size() > kMostContours)
      throw invalidInput(m_name + ": has " + std::to_string(m_file.points.size()) + " points and " +
                         std::to_string(m_file.contours.size()) +
                         " contours; expected at most 100000 and 10000");
    if (!m_isKnown)
      throw invalidInput(m_name +
                         ": has neither <path> nor <contourgroup>; expected a path (.pth) "
                         "or contours (.ctgr) of SimVascular");
    return std::move(m_file);
  }

private:
  void begin(std::string_view tag, const char** attributes) override {
    if (tag == "path" || tag == "contourgroup") {
      if (m_isKnown) return refuse("begins a second path; expected one for each file");
      m_isKnown = true;
      m_file.isPath = tag == "path";
      m_file.id = std::string(attribute(attributes, m_file.isPath ? "id" : "path_id"));
      m_file.name = std::string(attribute(attributes, "path_name"));
    } else if (tag == "timestep") {
      ++m_file.times;
    } else if (m_file.times == 1) {
      beginOfFirstTime(tag, attributes);
    }
  }

  void beginOfFirstTime(std::string_view tag, const char** attributes) {
    if (tag == "contour") {
      m_outline.clear();
      m_onPath = Vector3d::Zero();
    } else if (tag == "contour_points") {
      m_isOutline = true;
    } else if (tag == "pos") {
      (m_file.isPath ? m_file.points.emplace_back() : m_onPath) = place(attributes);
    } else if (tag == "point" && m_isOutline) {
      m_outline.push_back(place(attributes));
    }
  }

  void end(std::string_view tag) override {
    if (tag == "contour_points") m_isOutline = false;
    if (tag != "contour" || m_file.times != 1) return;
    if (std::optional<SvContour> contour = contourOf(m_outline)) {
      contour->onPath = m_onPath;
      m_file.contours.push_back(*contour);
    } else {
      ++m_file.withoutArea;
    }
  }

  Vector3d place(const char** attributes) {
    Vector3d place = Vector3d::Zero();
    for (Eigen::Index a = 0; a < 3; ++a) {
      const std::string name(1, "xyz"[a]);
      const std::string_view text = attribute(attributes, name);
      const auto value = parsedNumber(text);
      if (value && std::abs(*value) <= kLargestSv)
        place[a] = *value;
      else
        refuse(name + " is " + quotedText(std::string(text)) +
               "; expected a number from -1e9 to 1e9");
    }
    return place;
  }

  SvFile m_file;
  bool m_isKnown = false, m_isOutline = false;
  Vector3d m_onPath = Vector3d::Zero();
  std::vector<Vector3d> m_outline;
};

SvFile parseFile(std::string_view text, const fs::path& path) {
  const std::string name = formats::printable(path.string());
  SvFile file = SvReader(singleElement(text), name).parse();
  file.file = formats::printable(path.filename().string());
  if (file.isPath) file.name = formats::printable(path.stem().string());
  return file;
}

SvFile readFile(const InputFile& input) {
  return parseFile(input.read("centerline", kMostText), input.path());
}

// The course of contours along a path: its points between the first and the last of them, moved with the
// contours' middles and with their radii. Without a path, the middles alone.
std::vector<CurvePoint> courseOf(const SvFile& contours, const SvFile* path) {
  std::vector<CurvePoint> course;
  const std::vector<Vector3d> none;
  const std::vector<Vector3d>& along = path == nullptr ? none : path->points;
  std::vector<double> arc(along.size(), 0);
  for (std::size_t i = 1; i < along.size(); ++i)
    arc[i] = arc[i - 1] + (along[i] - along[i - 1]).norm();
  struct Placed {
    double arc;
    const SvContour* contour;
  };
  std::vector<Placed> placed;
  for (const SvContour& contour : contours.contours) {
    const auto nearest =
        std::min_element(along.begin(), along.end(), [&](const Vector3d& a, const Vector3d& b) {
          return (a - contour.onPath).squaredNorm() < (b - contour.onPath).squaredNorm();
        });
    placed.push_back(
        {along.empty() ? 0 : arc[static_cast<std::size_t>(nearest - along.begin())], &contour});
  }
  std::stable_sort(placed.begin(), placed.end(),
                   [](const Placed& a, const Placed& b) { return a.arc < b.arc; });
  std::size_t next = 0;
  for (std::size_t c = 0; c < placed.size(); ++c) {
    const SvContour& here = *placed[c].contour;
    course.push_back({here.centre, here.radius});
    if (c + 1 == placed.size()) break;
    const SvContour& then = *placed[c + 1].contour;
    while (next < arc.size() && arc[next] <= placed[c].arc) ++next;
    for (; next < arc.size() && arc[next] < placed[c + 1].arc; ++next) {
      const double t = (arc[next] - placed[c].arc) / (placed[c + 1].arc - placed[c].arc);
      course.push_back(
          {along[next] + (1 - t) * (here.centre - here.onPath) + t * (then.centre - then.onPath),
           (1 - t) * here.radius + t * then.radius});
    }
  }
  return course;
}

struct SvProject {
  std::vector<SvFile> paths, groups;
};

// The files of a kind in a project: in its folder `name`, or else in `folder` itself.
std::vector<InputFile> filesOf(const fs::path& project, const char* name, const fs::path& folder,
                               std::string_view ending) {
  std::error_code ignored;
  std::vector<InputFile> files = filesEndingIn(project / name, {ending}, ignored);
  return files.empty() ? filesEndingIn(folder, {ending}, ignored) : files;
}

bool isOfPath(const SvFile& group, const SvFile& path) {
  return group.name.empty() ? !group.id.empty() && group.id == path.id : group.name == path.name;
}

// The files that an input names: those of a project; or a path with its contours, or contours with their
// path, which lie beside it or in the project's other folder.
SvProject projectOf(const InputFile& input) {
  SvProject project;
  const auto add = [&](SvFile file) {
    (file.isPath ? project.paths : project.groups).push_back(std::move(file));
  };
  const bool isFolder = input.isFolder();
  if (!isFolder) add(readFile(input));
  if (input.isInMemory()) return project;
  const fs::path folder = isFolder ? input.path() : input.path().parent_path() / ".";
  const fs::path root = isFolder ? folder : folder / "..";
  if (isFolder || project.paths.empty())
    for (const InputFile& file : filesOf(root, "Paths", folder, kPath))
      if (isFolder || file.path().stem() == project.groups[0].name) add(readFile(file));
  if (isFolder || project.groups.empty())
    for (const InputFile& file : filesOf(root, "Segmentations", folder, kContours))
      if (SvFile group = readFile(file); isFolder || isOfPath(group, project.paths[0]))
        add(std::move(group));
  return project;
}

// The group that counts for a path: that of its name, or that of the most contours.
const SvFile* groupOf(const SvFile& path, const SvProject& project, std::size_t& others) {
  const SvFile* best = nullptr;
  const auto isNamed = [&](const SvFile& group) {
    return group.file == path.name + std::string(kContours);
  };
  for (const SvFile& group : project.groups) {
    if (!isOfPath(group, path) || group.contours.empty()) continue;
    others += best != nullptr ? 1 : 0;
    if (best == nullptr || isNamed(group) ||
        (!isNamed(*best) && group.contours.size() > best->contours.size()))
      best = &group;
  }
  return best;
}

// The vessels of a project, and what was left out, in sentences.
struct SvVessels {
  std::vector<std::vector<CurvePoint>> courses;
  std::vector<std::string> names, remarks;

  void add(std::string name, std::vector<CurvePoint> course) {
    if (course.empty()) return;
    names.push_back(std::move(name));
    courses.push_back(std::move(course));
  }
};

SvVessels vesselsOf(const SvProject& project) {
  SvVessels vessels;
  std::size_t without = 0, others = 0, straight = 0, withoutArea = 0, times = 1;
  for (const SvFile& path : project.paths) {
    const SvFile* group = groupOf(path, project, others);
    if (group == nullptr) {
      ++without;
      continue;
    }
    times = std::max({times, path.times, group->times});
    withoutArea += group->withoutArea;
    vessels.add(path.name, courseOf(*group, &path));
  }
  for (const SvFile& group : project.groups) {
    if (group.contours.empty() ||
        std::any_of(project.paths.begin(), project.paths.end(),
                    [&](const SvFile& path) { return isOfPath(group, path); }))
      continue;
    times = std::max(times, group.times);
    withoutArea += group.withoutArea;
    vessels.add(group.name, courseOf(group, nullptr));
    ++straight;
  }
  const bool hasRadii = !vessels.courses.empty();
  if (!hasRadii)
    for (const SvFile& path : project.paths) {
      std::vector<CurvePoint> course;
      for (const Vector3d& point : path.points) course.push_back({point, 0});
      vessels.add(path.name, std::move(course));
    }
  const auto remark = [&](std::size_t count, const char* one, const char* many, const char* rest) {
    if (count > 0) vessels.remarks.push_back(counted(count, one, many) + rest);
  };
  if (!hasRadii)
    vessels.remarks.emplace_back(
        "has paths alone, without radii; SimVascular saves contours around them in the project's "
        "folder Segmentations, and lumen reads the folder of the project");
  else
    remark(without, "path has no contours, and is left out",
           "paths have no contours, and are left out", "");
  remark(others, "further group", "further groups", " of contours of the same paths left out");
  remark(straight, "group of contours lies", "groups of contours lie",
         " without its path, so the vessel runs straight from middle to middle");
  remark(withoutArea, "contour has no area, and is left out",
         "contours have no area, and are left out", "");
  if (times > 1)
    vessels.remarks.push_back("holds " + std::to_string(times) +
                              " times, of which the first is read");
  return vessels;
}

CenterlineFile treeOfProject(const SvProject& project, const std::string& shown) {
  SvVessels vessels = vesselsOf(project);
  LineSet lines;
  bool hasRadii = false;
  for (std::size_t v = 0; v < vessels.courses.size(); ++v) {
    std::vector<std::int32_t>& line = lines.lines.emplace_back();
    for (const CurvePoint& point : vessels.courses[v]) {
      line.push_back(static_cast<std::int32_t>(lines.points.size()));
      lines.points.push_back(
          {point.position, point.radius, kNoPoint, 0, static_cast<std::int32_t>(v)});
      hasRadii = hasRadii || point.radius > 0;
    }
  }
  CenterlineFile file = treeOfLines(lines, lines, false, shown);
  if (file.points.empty())
    throw invalidInput(shown +
                       ": has no path with a length, nor two contours; expected a path (.pth), "
                       "contours (.ctgr), or the folder of a project of SimVascular");
  if (file.vessels.size() <= vessels.names.size())
    std::copy_n(vessels.names.begin(), file.vessels.size(), file.vessels.begin());
  file.isOfSimVascular = true;
  std::move(vessels.remarks.begin(), vessels.remarks.end(), std::back_inserter(file.remarks));
  if (hasRadii) fillRadii(file, shown, "contours around each path");
  return file;
}

}  // namespace

bool hasSimVascular(const fs::path& folder) {
  std::error_code ignored;
  return !filesOf(folder, "Segmentations", folder, kContours).empty() ||
         !filesEndingIn(folder / "Paths", {kPath}, ignored).empty();
}

CenterlineFile parseSimVascular(std::string_view text, const std::string& name) {
  SvFile file = parseFile(text, name);
  SvProject project;
  (file.isPath ? project.paths : project.groups).push_back(std::move(file));
  return treeOfProject(project, formats::printable(name));
}

CenterlineFile readSimVascular(const InputFile& fileOrFolder) {
  const std::string shown = formats::printable(fileOrFolder.path().string());
  return treeOfProject(projectOf(fileOrFolder), shown);
}

}  // namespace lumen::convert
