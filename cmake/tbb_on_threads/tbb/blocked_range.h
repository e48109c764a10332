// SPDX-License-Identifier: Apache-2.0
// A range of TBB that the project uses: see parallel_for.h.
#pragma once

namespace tbb {

template <class Value>
class blocked_range {
public:
  blocked_range(Value first, Value last) : m_first(first), m_last(last) {}
  Value begin() const { return m_first; }
  Value end() const { return m_last; }

private:
  Value m_first, m_last;
};

}  // namespace tbb
