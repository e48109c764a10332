// SPDX-License-Identifier: Apache-2.0
// Threshold between two classes of values.
#pragma once

#include <cstddef>
#include <span>

namespace lumen {

/// The bin of a histogram that splits the bins from `first` on into two classes whose means differ the
/// most, by the variance between them (N. Otsu, "A threshold selection method from gray-level
/// histograms", 1979): the first bin of the upper class.
inline std::size_t otsuSplit(std::span<const std::size_t> count, std::size_t first) {
  double all = 0, moment = 0;
  for (std::size_t i = first; i < count.size(); ++i) {
    all += static_cast<double>(count[i]);
    moment += static_cast<double>(count[i]) * static_cast<double>(i);
  }
  double below = 0, belowMoment = 0, greatest = -1;
  std::size_t best = first;
  for (std::size_t i = first; i + 1 < count.size(); ++i) {
    below += static_cast<double>(count[i]);
    belowMoment += static_cast<double>(count[i]) * static_cast<double>(i);
    if (below == 0 || below == all) continue;
    const double apart = belowMoment / below - (moment - belowMoment) / (all - below);
    const double between = below * (all - below) * apart * apart;
    if (between <= greatest) continue;
    greatest = between;
    best = i + 1;
  }
  return best;
}

}  // namespace lumen
