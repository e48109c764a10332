// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/renamed.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/shown_text.h"
#include "converters/base/text.h"
#include "converters/operations/naming.h"
#include "converters/stages/editing/edit_request.h"
#include "formats/container/printable.h"

namespace lumen::operations {

namespace {

using convert::quotedText;
using Labels = std::vector<std::string>;

Labels labelsOf(const formats::CenterlineTree& tree) {
  Labels labels;
  for (const formats::Branch& branch : tree.branches) labels.push_back(branch.label);
  return labels;
}

/// The label of every branch afterwards.
Labels labelsAfter(const Labels& now, std::span<const NewName> names) {
  Labels after = now;
  std::map<std::string, int> given;
  for (const NewName& name : names) {
    if (++given[name.label] > 1)
      throw invalidInput("found two new names for " + quotedText(name.label) + ", expected one");
    const auto branch = std::find(now.begin(), now.end(), name.label);
    if (branch == now.end())
      throw invalidInput("there is no branch " + quotedText(name.label) +
                         didYouMean(name.label, now));
    after[static_cast<std::size_t>(branch - now.begin())] = name.becomes;
  }
  Labels sorted = after;
  std::sort(sorted.begin(), sorted.end());
  if (const auto twice = std::adjacent_find(sorted.begin(), sorted.end()); twice != sorted.end())
    throw invalidInput("two branches would be called " + quotedText(*twice) +
                       "; expected a name of its own for each");
  return after;
}

}  // namespace

formats::Case renamed(formats::Case value, std::span<const NewName> names,
                      const std::string& name) {
  return naming(name, [&] {
    Labels now = labelsOf(value.tree);
    const Labels after = labelsAfter(now, names);
    const auto rename = [&](std::uint32_t branch, const std::string& label) {
      convert::EditRequest request;
      request.op = "rename";
      request.branch = branch;
      request.word = label;
      (void)convert::applyEdit(value, request);
      now[branch] = label;
    };
    const auto isFree = [&](const std::string& label) {
      return std::find(now.begin(), now.end(), label) == now.end();
    };
    while (now != after) {
      std::uint32_t waiting = 0;
      bool isAny = false;
      for (std::uint32_t b = 0; b < now.size(); ++b) {
        if (now[b] == after[b]) continue;
        waiting = b;
        if (!isFree(after[b])) continue;
        rename(b, after[b]);
        isAny = true;
      }
      // names that change in a circle begin with one that nobody has
      if (isAny || now == after) continue;
      std::string between = now[waiting] + "-";
      while (!isFree(between)) between += "-";
      rename(waiting, between);
    }
    return std::move(value);
  });
}

}  // namespace lumen::operations
