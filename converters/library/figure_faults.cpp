// SPDX-License-Identifier: Apache-2.0
#include "converters/library/figure_faults.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/shown_text.h"
#include "converters/library/record_of_case.h"

namespace lumen::convert {

namespace {

constexpr double kSame = 1e-3;          // mm, and of unit vectors
constexpr double kSameRelative = 1e-5;  // sums of lengths: a hundred roundings of a float

bool isSame(double a, double b) {
  return std::abs(a - b) <= std::max(kSame, kSameRelative * std::max(std::abs(a), std::abs(b)));
}

/// Measures of geometry are extremes over places, which rounding may exchange.
bool isAlike(double a, double b) {
  constexpr double kAlike = 0.01;
  return std::abs(a - b) <= kAlike * std::max({1.0, std::abs(a), std::abs(b)});
}

bool isSame(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return isSame(a.x(), b.x()) && isSame(a.y(), b.y()) && isSame(a.z(), b.z());
}

/// Comparison of the record's figures with those of the case.
class Figures {
public:
  Figures(const CaseRecord& record, const std::string& path, FaultList& faults)
      : m_id(record.id), m_path(path), m_faults(faults) {}

  void compare(const std::string& what, const std::optional<double>& found,
               const std::optional<double>& expected) {
    if (found.has_value() != expected.has_value() || (found && !isSame(*found, *expected)))
      report(what + " " + (found ? shownNumber(*found) : "null"),
             expected ? shownNumber(*expected) : "null");
  }
  void compareAlike(const std::string& what, const std::optional<double>& found,
                    const std::optional<double>& expected) {
    if (found && expected && isAlike(*found, *expected)) return;
    compare(what, found, expected);
  }
  void compare(const std::string& what, std::size_t found, std::size_t expected) {
    if (found != expected) report(what + " " + std::to_string(found), std::to_string(expected));
  }
  void compare(const std::string& what, const Eigen::Vector3d& found,
               const Eigen::Vector3d& expected) {
    if (!isSame(found, expected)) report(what + " " + vectorText(found), vectorText(expected));
  }
  void compare(const std::string& what, const std::string& found, const std::string& expected) {
    if (found != expected) report(what + " " + quotedText(found), quotedText(expected));
  }
  void compare(const std::string& what, const std::vector<CasePlace>& found,
               const std::vector<CasePlace>& expected) {
    compare("a number of " + what + " of", found.size(), expected.size());
    for (std::size_t i = 0; i < std::min(found.size(), expected.size()); ++i) {
      const CasePlace &a = found[i], &b = expected[i];
      const std::string which = what + "/" + std::to_string(i) + "/";
      compare(which + "name", a.name, b.name);
      compare(which + "kind", a.kind, b.kind);
      compare(which + "position", a.position, b.position);
      compare(which + "direction", a.direction, b.direction);
      compare(which + "radius", std::optional(a.radius), std::optional(b.radius));
    }
  }

  void report(const std::string& found, const std::string& expected) {
    m_faults.add({FaultCode::CaseFigures, m_id, m_path, found, expected + ", as the case gives"});
  }

private:
  const std::string& m_id;
  const std::string& m_path;
  FaultList& m_faults;
};

}  // namespace

void checkFigures(const formats::Case& value, const CaseRecord& record, const std::string& path,
                  FaultList& faults) {
  Figures figures(record, path, faults);
  CaseRecord made = record;
  try {
    Progress quiet;  // one of many cases at once: their stages are not shown
    describe(value, "", made, quiet);
  } catch (const Error& error) {
    return figures.report("figures", std::string("none (") + error.what() + ")");
  }
  const CaseFigures &found = record.figures, &expected = made.figures;
  using Number = std::optional<double>;
  figures.compare("bounds/min", record.boundsMin, made.boundsMin);
  figures.compare("bounds/max", record.boundsMax, made.boundsMax);
  figures.compare("figures/branches", found.branches, expected.branches);
  figures.compare("figures/aneurysms", found.aneurysms, expected.aneurysms);
  figures.compare("figures/nodes", found.nodes, expected.nodes);
  figures.compare("figures/length_mm", Number(found.length), Number(expected.length));
  figures.compare("figures/radius_mm/min", Number(found.radiusMin), Number(expected.radiusMin));
  figures.compare("figures/radius_mm/mean", Number(found.radiusMean), Number(expected.radiusMean));
  figures.compare("figures/radius_mm/max", Number(found.radiusMax), Number(expected.radiusMax));
  figures.compare("figures/fit_error_mm/median", found.errorMedian, expected.errorMedian);
  figures.compare("figures/fit_error_mm/p90", found.errorP90, expected.errorP90);
  figures.compare("figures/reachable_mm", found.reachable, expected.reachable);
  if (found.geometry)
    for (const GeometryKey& figure : kGeometryKeys)
      figures.compareAlike(std::string("figures/geometry/") + figure.key,
                           (*found.geometry).*figure.value, (*expected.geometry).*figure.value);
  figures.compare("insertions", record.insertions, made.insertions);
  figures.compare("ends", record.ends, made.ends);
}

}  // namespace lumen::convert
