// SPDX-License-Identifier: Apache-2.0
// Statements of a person about vessels that a case has already: names and parents (docs/method.md,
// section 1.14). No hint moves a node or a wall: hints name, divide, turn and join.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/io/seeds/seeds.h"
#include "converters/stages/editing/inlets.h"
#include "formats/case/case.h"

namespace lumen::convert {

struct HintRemarks {
  /// Hints that lie in no vessel of the case, and aneurysms, whose walls have to be captured: seeds
  /// for addTracksFromSeeds(). The parent of a vessel is another of them or none, as the lumen
  /// shows which vessel of the case it leaves; that of an aneurysm may be a branch of the case.
  std::vector<SeedBranch> rest;
  std::vector<SeedFailure> missedPoints;  ///< points of a hint that lie outside of its vessel
  std::vector<SeedFailure> unused;        ///< hints in a vessel that has another hint's name
  std::vector<SeedFailure> unjoined;      ///< vessels that do not hang on the stated parent
  std::vector<SeedFailure> halved;        ///< hints whose vessel was divided far from any fork
  std::vector<SeedFailure> unrooted;      ///< hints of kind root where blood does not come in
  std::vector<UnusedPlace> unusedRoots;   ///< of `roots`
  /// Labels of the hints that lie in a vessel, and the label that it has: another one's for `unused`.
  std::map<std::string, std::string> holders;
};

/// Gives the vessels of a valid case that was not fitted the names of the hints that lie in them.
/// Where several lie in one vessel it is divided between them: at the last branch that leaves it
/// before the next hint, with which the vessel goes on, or in the middle. Branches with a hint's name, but without the hint, get another name. The
/// trees begin at `roots`, and where hints of kind root lie and hints that are parents and have none
/// (inlets.h). A
/// vessel of another tree than its stated parent is joined to that if the gap is shorter than the
/// vessel. Aneurysms of the case that lie in one of the hints are deleted. The "edit" step has one
/// sentence about all. Positions are placed: mm, LPS.
HintRemarks applyHints(formats::Case& target, const std::vector<SeedBranch>& hints,
                       std::span<const Eigen::Vector3d> roots = {});

}  // namespace lumen::convert
