// SPDX-License-Identifier: Apache-2.0
// A reduction of TBB that the project uses, in two halves: see parallel_for.h.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_invoke.h>

namespace tbb {

template <class Value, class Result, class Body, class Join>
Result parallel_reduce(const blocked_range<Value>& range, const Result& identity, const Body& body,
                       const Join& join) {
  const Value middle = range.begin() + (range.end() - range.begin()) / 2;
  Result low = identity, high = identity;
  parallel_invoke([&] { low = body(blocked_range<Value>(range.begin(), middle), identity); },
                  [&] { high = body(blocked_range<Value>(middle, range.end()), identity); });
  return join(low, high);
}

}  // namespace tbb
