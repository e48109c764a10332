// SPDX-License-Identifier: Apache-2.0
// Seeds that a case holds: those that it was tracked with, and those that wait (spec/lumen.md,
// "Seeds").
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "converters/io/seeds/seeds.h"

namespace lumen::convert {

/// The seeds of a case, parents first, in mm and LPS; none if it holds none. A parent may also be a
/// vessel of the case; one that is neither is left out. Throws Error(InvalidInput), with `name` as
/// the file, if they break a rule of the seeds format.
std::vector<SeedBranch> seedsOf(const formats::Case& value, const std::string& name,
                                const FieldWord& word = {});

/// Replaces the seeds of a case by `seeds`, which are in mm and LPS; without one it holds none.
void setSeeds(formats::Case& value, const std::vector<SeedBranch>& seeds);

/// Whether a case holds these seeds and no others, all alike.
bool holdsSeeds(const formats::Case& value, const std::vector<SeedBranch>& seeds);

/// The seeds that a case was tracked with, for setSeeds(): those of `failures` wait, the others are
/// tracked.
std::vector<SeedBranch> markTracked(std::vector<SeedBranch> seeds,
                                    const std::vector<SeedFailure>& failures);

/// Leaves out parents that are no seed of the list, as a file of seeds needs it.
void dropOtherParents(std::vector<SeedBranch>& seeds);

/// Numbers of the seeds of a case.
struct SeedCounts {
  std::size_t tracked = 0, waiting = 0;
};

/// Counts the seeds of a case; throws as seedsOf().
SeedCounts countSeeds(const formats::Case& value, const std::string& name);

}  // namespace lumen::convert
