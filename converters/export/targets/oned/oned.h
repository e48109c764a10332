// SPDX-License-Identifier: Apache-2.0
// A case as the input of solvers of blood flow in one dimension: svOneDSolver of SimVascular, and
// openBF.
#pragma once

#include "converters/export/shared/target.h"

namespace lumen::convert {

/// Two descriptions of each tree, of one oneDNetwork(): TREE.in for svOneDSolver, in cgs, and
/// TREE.yml with TREE_inlet.dat for openBF v2, in SI. Trees are `vessels`, `vessels2`, .... Throws
/// as flowNetwork() and oneDNetwork().
ExportResult exportOneD(const ExportInput& input);

TargetRow oneDRow();

}  // namespace lumen::convert
