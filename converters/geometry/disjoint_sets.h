// SPDX-License-Identifier: Apache-2.0
// Union-find.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace lumen::convert {

/// Sets of 0 .. size - 1, each named by its smallest member, so that names do not depend on the
/// order of joins.
class DisjointSets {
public:
  explicit DisjointSets(std::size_t size = 0) : m_parent(size) {
    std::iota(m_parent.begin(), m_parent.end(), 0U);
  }
  std::uint32_t add() {
    m_parent.push_back(static_cast<std::uint32_t>(m_parent.size()));
    return m_parent.back();
  }
  [[nodiscard]] std::uint32_t find(std::uint32_t member) {
    while (m_parent[member] != member) {
      m_parent[member] = m_parent[m_parent[member]];
      member = m_parent[member];
    }
    return member;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    if (a < b) m_parent[b] = a;
    if (b < a) m_parent[a] = b;
  }

private:
  std::vector<std::uint32_t> m_parent;
};

}  // namespace lumen::convert
