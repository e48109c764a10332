// SPDX-License-Identifier: Apache-2.0
#include "converters/geometry/automatic_names.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "converters/base/vectors.h"
#include "formats/view/limits.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {
namespace {

const std::string kProvisional = "vessel-";

/// Takes digits off the front of a text.
std::string takeNumber(std::string& text) {
  const std::size_t end = std::min(text.find_first_not_of("0123456789"), text.size());
  std::string number = text.substr(0, end);
  text.erase(0, end);
  return number;
}

/// Numbers, each behind a hyphen, to the end.
bool arePieces(std::string text) {
  while (text.starts_with('-')) {
    text.erase(0, 1);
    if (takeNumber(text).empty()) return false;
  }
  return text.empty();
}

bool isProvisional(const std::string& label) {
  if (!label.starts_with(kProvisional)) return false;
  std::string rest = label.substr(kProvisional.size());
  return !takeNumber(rest).empty() && arePieces(std::move(rest));
}

/// The place that a name states.
struct NamedPlace {
  std::string tree;
  std::string
      limb;  ///< the number of the vessel that leaves the first one; empty: it is that vessel
};

std::optional<NamedPlace> placeNamed(const std::string& label) {
  const std::size_t end = label.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ");
  if (end == 0 || end == std::string::npos || label[end] != '.') return {};
  std::string rest = label.substr(end + 1), limb = takeNumber(rest);
  if (limb.empty()) return {};
  if (rest.starts_with('.')) {
    rest.erase(0, 1);
    if (takeNumber(rest).empty()) return {};
  }
  if (!arePieces(std::move(rest))) return {};
  return NamedPlace{label.substr(0, end), limb == "0" ? std::string{} : limb};
}

/// A, B, ... Z, AA, AB, ...
std::string lettersOf(std::size_t index) {
  std::string letters;
  for (std::size_t rest = index + 1; rest > 0; rest = (rest - 1) / 26)
    letters.insert(letters.begin(), static_cast<char>('A' + (rest - 1) % 26));
  return letters;
}

class TreeNames {
public:
  TreeNames(formats::CenterlineTree& tree, std::size_t first, const std::set<std::string>& kept)
      : m_tree(tree),
        m_isDue(tree.branches.size()),
        m_root(tree.branches.size()),
        m_limb(tree.branches.size()),
        m_stem(tree.branches.size()) {
    for (std::size_t b = 0; b < m_isDue.size(); ++b) {
      const formats::Branch& branch = tree.branches[b];
      m_isDue[b] = b >= first && branch.kind == formats::BranchKind::Vessel &&
                   isProvisional(branch.label) && !kept.contains(branch.label);
      if (!m_isDue[b]) m_taken.insert(branch.label);
      const std::size_t above = parentOf(b);
      m_root[b] = above == kNone ? b : m_root[above];
      m_limb[b] = above == kNone ? kNone : m_limb[above] == kNone ? b : m_limb[above];
    }
  }

  void give() {
    takeStems();
    for (const std::size_t b : largestFirst()) {
      if (m_tree.branches[b].kind != formats::BranchKind::Vessel) continue;
      const std::string name = nameOf(b);
      if (m_isDue[b]) m_tree.branches[b].label = name;
    }
  }

private:
  static constexpr std::size_t kNone = SIZE_MAX;

  [[nodiscard]] std::size_t parentOf(std::size_t b) const {
    const std::int32_t node = m_tree.branches[b].parentNode;
    return node == formats::kNoParent ? kNone : m_tree.branch[static_cast<std::size_t>(node)];
  }

  /// The trees and limbs whose vessels have names by their place already.
  void takeStems() {
    for (std::size_t b = 0; b < m_isDue.size(); ++b) {
      if (m_isDue[b]) continue;
      const auto place = placeNamed(m_tree.branches[b].label);
      if (!place) continue;
      m_letters.insert(place->tree);
      if (m_stem[m_root[b]].empty()) m_stem[m_root[b]] = place->tree;
      if (m_limb[b] != kNone && !place->limb.empty() && m_stem[m_limb[b]].empty())
        m_stem[m_limb[b]] = place->tree + "." + place->limb;
    }
  }

  /// Branches in the order of the lumen of each with all that hangs on it, so parents come first.
  [[nodiscard]] std::vector<std::size_t> largestFirst() const {
    std::vector<double> lumen(m_isDue.size(), 0);
    for (std::size_t b = m_isDue.size(); b-- > 0;) {
      const formats::Branch& branch = m_tree.branches[b];
      const std::uint32_t end = branch.firstNode + branch.nodeCount;
      for (std::uint32_t n = branch.firstNode + 1; n < end; ++n)
        lumen[b] += (toEigen(m_tree.centre[n]) - toEigen(m_tree.centre[n - 1])).norm() *
                    double{m_tree.radius[n]} * double{m_tree.radius[n]};
      if (const std::size_t above = parentOf(b); above != kNone) lumen[above] += lumen[b];
    }
    std::vector<std::size_t> order(lumen.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return lumen[a] > lumen[b]; });
    return order;
  }

  /// A name of the place of a branch, which is used up by it.
  std::string nameOf(std::size_t b) {
    const std::size_t root = m_root[b], limb = m_limb[b];
    if (m_stem[root].empty()) m_stem[root] = freeLetters();
    if (b == root) {
      const std::string name = m_stem[root] + ".0";
      return m_isDue[b] && !m_taken.insert(name).second ? numbered(m_stem[root], b) : name;
    }
    if (b != limb) return numbered(m_stem[limb], b);
    if (m_stem[limb].empty() || m_isDue[b]) m_stem[limb] = numbered(m_stem[root], b);
    return m_stem[limb];
  }

  std::string freeLetters() {
    for (std::size_t index = 0;; ++index)
      if (const std::string letters = lettersOf(index); m_letters.insert(letters).second)
        return letters;
  }

  std::string numbered(const std::string& stem, std::size_t b) {
    // a name by its place is counted by itself
    if (!m_isDue[b] && placeNamed(m_tree.branches[b].label)) return m_tree.branches[b].label;
    for (;;)
      if (const std::string name = stem + "." + std::to_string(++m_numbers[stem]);
          m_taken.insert(name).second)
        return name;
  }

  formats::CenterlineTree& m_tree;
  std::vector<bool> m_isDue;
  std::vector<std::size_t> m_root, m_limb;  // branches; kNone for the limb of a first vessel
  std::vector<std::string>
      m_stem;  // of roots and limbs: the beginning of names of what hangs on them
  std::set<std::string> m_taken, m_letters;
  std::map<std::string, std::size_t> m_numbers;
};

}  // namespace

std::string provisionalName(std::size_t number) {
  return kProvisional + std::to_string(number);
}

bool isAutomaticName(const std::string& label) {
  return isProvisional(label) || placeNamed(label).has_value();
}

std::string PieceName::text() const {
  if (piece == 1) return vessel;
  std::string ending(1, '-');
  ending += std::to_string(piece);
  std::string text = vessel.substr(0, formats::kMaxNameBytes - ending.size());
  while (!formats::isUtf8(text)) text.pop_back();
  return text + ending;
}

PieceName pieceNameOf(const std::string& label) {
  const std::size_t least = label.starts_with(kProvisional) ? kProvisional.size() : 0;
  const std::size_t hyphen = label.find_last_of('-');
  if (!isAutomaticName(label) || hyphen == std::string::npos || hyphen < least) return {label};
  PieceName name{label.substr(0, hyphen)};
  std::from_chars(label.data() + hyphen + 1, label.data() + label.size(), name.piece);
  // one label, one piece: -1 and -02 are none
  return name.piece > 1 && name.text() == label ? name : PieceName{label};
}

std::string freeName(const std::string& name, const std::set<std::string>& taken) {
  if (!taken.contains(name)) return name;
  PieceName next = pieceNameOf(name);
  do ++next.piece;
  while (taken.contains(next.text()));
  return next.text();
}

void nameAutomatically(formats::CenterlineTree& tree, std::size_t first,
                       const std::set<std::string>& kept) {
  TreeNames(tree, first, kept).give();
}

}  // namespace lumen::convert
