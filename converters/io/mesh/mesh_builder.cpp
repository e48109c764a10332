// SPDX-License-Identifier: Apache-2.0
#include "converters/io/mesh/mesh_builder.h"

#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/options/stated_unit.h"
#include "formats/container/printable.h"

namespace lumen::convert {
namespace {

constexpr std::size_t kFirstTable = 1024;

std::uint64_t hashOf(const Eigen::Vector3d& point) {
  std::uint64_t hash = 0x9E3779B97F4A7C15U;
  for (Eigen::Index a = 0; a < 3; ++a) {
    hash ^= std::bit_cast<std::uint64_t>(point[a] + 0.0);  // -0 becomes 0
    hash *= 0xBF58476D1CE4E5B9U;
    hash ^= hash >> 31;
  }
  return hash;
}

}  // namespace

void refuseMesh(const std::string& name, const std::string& place, const std::string& what) {
  throw invalidInput(name + ": " + (place.empty() ? "" : place + ": ") + what);
}

void MeshBuilder::refusePoint(const Eigen::Vector3d& point, const std::string& place) const {
  for (Eigen::Index a = 0; a < 3; ++a) {
    if (std::abs(point[a]) <= kLargestCoordinate) continue;
    refuseMesh(m_name, place,
               std::string("the ") + "xyz"[a] + " of a point is " + shownNumber(point[a]) +
                   "; expected a finite number, at most 1e12");
  }
  std::abort();  // only called for invalid points
}

std::uint32_t MeshBuilder::sharedIndex(const Eigen::Vector3d& point) {
  std::vector<Eigen::Vector3d>& position = file.mesh.position;
  if (2 * position.size() >= m_table.size()) growTable();
  const std::size_t mask = m_table.size() - 1;
  std::size_t slot = hashOf(point) & mask;
  while (m_table[slot] != 0) {
    const std::uint32_t index = m_table[slot] - 1;
    if (position[index] == point) return index;
    slot = (slot + 1) & mask;
  }
  position.push_back(point);
  m_table[slot] = static_cast<std::uint32_t>(position.size());
  return m_table[slot] - 1;
}

void MeshBuilder::growTable() {
  m_table.assign(std::max(kFirstTable, 2 * m_table.size()), 0);
  const std::size_t mask = m_table.size() - 1;
  for (std::size_t i = 0; i < file.mesh.position.size(); ++i) {
    std::size_t slot = hashOf(file.mesh.position[i]) & mask;
    while (m_table[slot] != 0) slot = (slot + 1) & mask;
    m_table[slot] = static_cast<std::uint32_t>(i + 1);
  }
}

void MeshBuilder::addPolygon(const std::uint32_t* corner, std::size_t count) {
  if (file.groups.empty()) beginGroup("");
  for (std::size_t i = 2; i < count; ++i) {
    file.mesh.triangle.push_back({corner[0], corner[i - 1], corner[i]});
    file.group.push_back(m_current);
  }
}

void MeshBuilder::beginGroup(std::string_view group) {
  const auto [entry, isNew] =
      m_groupIndex.try_emplace(std::string(group), static_cast<std::uint32_t>(file.groups.size()));
  if (isNew) file.groups.emplace_back(group);
  m_current = entry->second;
}

MeshFile MeshBuilder::finish(bool flipXy) {
  if (file.mesh.triangle.empty())
    refuseMesh(m_name, "", "has no triangles; expected a surface of at least one");
  if (flipXy)
    for (Eigen::Vector3d& p : file.mesh.position) p = {-p.x(), -p.y(), p.z()};
  // groups without triangles are dropped
  std::vector<std::uint32_t> renumbered(file.groups.size(), 0);
  for (const std::uint32_t g : file.group) renumbered[g] = 1;
  std::vector<std::string> names;
  for (std::size_t g = 0; g < file.groups.size(); ++g)
    if (renumbered[g] != 0) {
      renumbered[g] = static_cast<std::uint32_t>(names.size());
      names.push_back(std::move(file.groups[g]));
    }
  const bool unnamed = names.size() == 1 && names.front().empty();
  file.groups = unnamed ? std::vector<std::string>() : std::move(names);
  if (unnamed) file.group.clear();
  for (std::uint32_t& g : file.group) g = renumbered[g];
  return std::move(file);
}

void StatedFrame::look(std::string_view comment) {
  comment = comment.substr(0, comment.find('\0'));  // a header of fixed size is filled with zeros
  const auto has = [&](std::string_view words) { return comment.find(words) != comment.npos; };
  if (has("SPACE=RAS")) ras = true;
  if (has("SPACE=LPS")) lps = true;
  if (has("mm, LPS") || has("mm, SPACE=LPS") || has("millimetres, LPS")) {
    lps = true;
    unit = 1;
  } else if (const auto stated = unitInComment(std::string(comment))) {
    unit = stated->millimetres;
    notes = {stated->sentence()};
  }
}

MeshFile finishStated(MeshBuilder& builder, const StatedFrame& frame) {
  builder.file.frameStated = frame.ras || frame.lps;
  builder.file.unitMm = frame.unit;
  builder.file.isTurned = frame.ras;
  if (frame.ras) builder.file.notes.emplace_back(kTurnedNote);
  builder.file.notes.insert(builder.file.notes.end(), frame.notes.begin(), frame.notes.end());
  return builder.finish(frame.ras);
}

}  // namespace lumen::convert
