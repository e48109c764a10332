// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/trees_from_surfaces/label_systems.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include "converters/geometry/disjoint_sets.h"
#include "converters/voxels/depth.h"
#include "converters/voxels/voxel_set.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::VesselSystem;

/// Widths of a vessel along its section at 30 degrees. Branches seldom leave at less, and none at
/// half of that.
constexpr double kLongestSection = 2;

/// Voxels of two labels that touch.
struct LabelContact {
  std::uint8_t a = 0, b = 0;                  ///< places of the labels, counted from 1, a < b
  std::size_t faces = 0;                      ///< that both share
  std::vector<std::size_t> besideA, besideB;  ///< voxels of b, and of a, at these faces
};

bool mayBeAnyVessel(LabelRole role) {
  return role == LabelRole::Unknown || role == LabelRole::Vessel;
}

/// Roles leave open whether two labels are of one tree.
bool isOpenQuestion(LabelRole a, LabelRole b) {
  const auto isLumen = [](LabelRole role) {
    return mayBeAnyVessel(role) || systemOf(role) != VesselSystem::Unknown;
  };
  return isLumen(a) && isLumen(b) && (mayBeAnyVessel(a) || mayBeAnyVessel(b));
}

std::vector<LabelContact> findContacts(const LabelMask& mask, const Progress& progress) {
  std::map<std::pair<std::uint8_t, std::uint8_t>, LabelContact> found;
  const CellBox cells = mask.geometry.cells();
  for (std::size_t i = 0; i < mask.label.size(); ++i) {
    if (i % 65536 == 0) progress.check();
    const std::uint8_t own = mask.label[i];
    if (own == 0) continue;
    const Cell at = cells.cell(i);
    cells.forEachNeighbour(at, [&](const Cell& cell) {
      const std::size_t k = cells.index(cell);
      const std::uint8_t other = mask.label[k];
      if (other <= own) return;
      LabelContact& contact = found[{own, other}];
      contact.a = own;
      contact.b = other;
      if ((cell - at).squaredNorm() > 1) return;
      ++contact.faces;
      contact.besideB.push_back(i);
      contact.besideA.push_back(k);
    });
  }
  std::vector<LabelContact> contacts;
  for (auto& [labels, contact] : found) contacts.push_back(std::move(contact));
  std::stable_sort(contacts.begin(), contacts.end(),
                   [](const LabelContact& x, const LabelContact& y) { return x.faces > y.faces; });
  return contacts;
}

/// The greatest distance between two voxels of one connected part of a set, mm, found from any voxel
/// in two steps: to the farthest from it, and to the farthest from that one.
double longestPart(const VoxelSet& set) {
  const auto farthest = [&](const std::vector<std::uint32_t>& part, std::uint32_t from) {
    return *std::max_element(part.begin(), part.end(), [&](std::uint32_t x, std::uint32_t y) {
      return (set.position(x) - set.position(from)).squaredNorm() <
             (set.position(y) - set.position(from)).squaredNorm();
    });
  };
  double longest = 0;
  std::vector<bool> isSeen(set.size(), false);
  for (std::uint32_t first = 0; first < set.size(); ++first) {
    if (isSeen[first]) continue;
    std::vector<std::uint32_t> part{first};
    isSeen[first] = true;
    for (std::size_t k = 0; k < part.size(); ++k)
      set.eachBeside(part[k], [&](std::uint32_t j, const Vector3d&) {
        if (isSeen[j]) return;
        isSeen[j] = true;
        part.push_back(j);
      });
    const std::uint32_t end = farthest(part, first);
    longest = std::max(longest, (set.position(farthest(part, end)) - set.position(end)).norm());
  }
  return longest;
}

/// Depths around the contact of two labels, in voxels of a box that holds all balls up to a quarter
/// of the contact's length.
class ContactDepths {
public:
  ContactDepths(const LabelMask& mask, const LabelContact& contact, double length,
                const Progress& progress)
      : m_mask(mask), m_contact(contact), m_progress(progress) {
    const CellBox cells = mask.geometry.cells();
    Cell low = cells.high(), high = Cell::Zero();
    for (const std::size_t i : contact.besideB) {
      low = low.cwiseMin(cells.cell(i));
      high = high.cwiseMax(cells.cell(i));
    }
    const Cell reach =
        (0.5 * length / mask.geometry.spacing.array()).ceil().cast<int>().matrix() + Cell::Ones();
    m_box = cells.meet(CellBox::between(low - reach, high + reach));
  }

  /// Radius of the largest ball that lies in both labels together with its centre at their contact.
  [[nodiscard]] double opening() const {
    const std::vector<float> depths =
        distances([&](std::uint8_t l) { return l == m_contact.a || l == m_contact.b; });
    double most = 0;
    for (std::size_t k = 0; k < m_contact.besideA.size(); ++k)
      most = std::max(most,
                      0.5 * (at(depths, m_contact.besideA[k]) + at(depths, m_contact.besideB[k])));
    return most - 0.5 * voxel();
  }

  /// The same of the largest ball that lies in one label alone and touches the other.
  [[nodiscard]] double ball(std::uint8_t label, std::uint8_t other) const {
    const std::vector<float> depths = distances([&](std::uint8_t l) { return l == label; });
    const std::vector<float> toOther = distances([&](std::uint8_t l) { return l != other; });
    double most = 0;
    for (std::size_t i = 0; i < depths.size(); ++i)
      if (double{toOther[i]} <= double{depths[i]} + voxel())
        most = std::max(most, double{depths[i]});
    return most - 0.5 * voxel();
  }
  [[nodiscard]] double voxel() const { return m_mask.geometry.voxelSize(); }

private:
  /// Distances to the nearest voxel whose label is not within, mm.
  template <class IsWithin>
  [[nodiscard]] std::vector<float> distances(const IsWithin& isWithin) const {
    std::vector<std::uint8_t> mark;
    mark.reserve(m_box.count());
    m_box.forEach([&](const Cell& cell) {
      mark.push_back(isWithin(m_mask.label[m_mask.geometry.index(cell)]) ? 1 : 0);
    });
    return distancesTo(m_box, m_mask.geometry.spacing, mark, 0, m_progress);
  }
  [[nodiscard]] double at(const std::vector<float>& depths, std::size_t voxel) const {
    return double{depths[m_box.index(m_mask.geometry.cell(voxel))]};
  }

  const LabelMask& m_mask;
  const LabelContact& m_contact;
  const Progress& m_progress;
  CellBox m_box;
};

bool touchSideBySide(const LabelMask& mask, const LabelContact& contact, const Progress& progress) {
  std::vector<std::size_t> voxels = contact.besideA;
  voxels.insert(voxels.end(), contact.besideB.begin(), contact.besideB.end());
  std::sort(voxels.begin(), voxels.end());
  voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
  const double length = longestPart(VoxelSet(mask.geometry, std::move(voxels)));
  const double voxel = mask.geometry.voxelSize();
  if (length < 2 * kLongestSection * voxel) return false;
  const ContactDepths depths(mask, contact, length, progress);
  const double thinner =
      std::min(depths.ball(contact.a, contact.b), depths.ball(contact.b, contact.a));
  // both radii are known to half a voxel; a contact as long as no branch's needs no such margin
  const double sections = length / (2 * thinner * kLongestSection);
  const double opening = depths.opening();
  return (sections > 1 && opening + 0.5 * voxel <= thinner) || (sections > 2 && opening < thinner);
}

/// Labels that are of one part, as sets.
DisjointSets joinedLabels(const LabelMask& mask, std::span<const LabelRole> roles,
                          const std::vector<LabelContact>& contacts, const Progress& progress) {
  DisjointSets trees(roles.size());
  std::vector<std::vector<std::uint32_t>> members(roles.size());
  for (std::uint32_t l = 0; l < roles.size(); ++l) members[l] = {l};
  const auto areApart = [&](std::uint32_t one, std::uint32_t other) {
    for (const std::uint32_t x : members[one])
      for (const std::uint32_t y : members[other])
        if (formats::areApart(systemOf(roles[x]), systemOf(roles[y]))) return true;
    return false;
  };
  for (const LabelContact& contact : contacts) {
    const std::uint32_t a = contact.a - 1U, b = contact.b - 1U;
    const std::uint32_t one = trees.find(a), other = trees.find(b);
    if (one == other || areApart(one, other)) continue;
    if (isOpenQuestion(roles[a], roles[b]) && touchSideBySide(mask, contact, progress)) continue;
    trees.join(one, other);
    const std::uint32_t whole = trees.find(one), rest = whole == one ? other : one;
    members[whole].insert(members[whole].end(), members[rest].begin(), members[rest].end());
  }
  return trees;
}

}  // namespace

std::vector<std::uint8_t> partsOfLabels(const LabelMask& mask, std::span<const LabelRole> roles,
                                        const Progress& progress) {
  std::vector<std::uint8_t> parts(roles.size(), 0);
  if (parts.size() < 2) return parts;
  const std::vector<LabelContact> contacts = findContacts(mask, progress);
  DisjointSets trees = joinedLabels(mask, roles, contacts, progress);
  // sets that touch lie in unlike parts; the name of a set is its first label
  for (std::uint32_t l = 0; l < parts.size(); ++l) {
    const std::uint32_t tree = trees.find(l);
    if (tree != l) {
      parts[l] = parts[tree];
      continue;
    }
    std::vector<bool> isTaken(parts.size(), false);
    for (const LabelContact& contact : contacts)
      for (const auto& [own, other] : {std::pair{contact.a, contact.b}, {contact.b, contact.a}}) {
        const std::uint32_t beside = trees.find(other - 1U);
        if (trees.find(own - 1U) == tree && beside < tree) isTaken[parts[beside]] = true;
      }
    parts[l] = static_cast<std::uint8_t>(std::find(isTaken.begin(), isTaken.end(), false) -
                                         isTaken.begin());
  }
  return parts;
}

LabelMask partOfMask(const LabelMask& mask, std::span<const std::uint8_t> parts,
                     std::uint8_t part) {
  LabelMask out = mask;
  for (std::uint8_t& label : out.label)
    if (label != 0 && parts[label - 1U] != part) label = 0;
  return out;
}

}  // namespace lumen::convert
