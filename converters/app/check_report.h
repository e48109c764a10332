// SPDX-License-Identifier: Apache-2.0
// What `lumen check --json` answers.
#pragma once

#include <cstdint>
#include <string>

#include <Eigen/Core>

#include "converters/app/report.h"
#include "converters/check/check.h"

namespace lumen::app {

/// The label of a node's branch.
const std::string& labelOf(const formats::CenterlineTree& tree, std::uint32_t node);

/// The middle of a vessel's way, mm, LPS.
const Eigen::Vector3d& middleOf(const convert::MissingVessel& vessel);

/// part / whole; not a number unless `whole` is above 0.
double share(double part, double whole);

/// spec/answers/check.schema.json. `source`: whether the volume is the one that the case is of.
Json checkJson(const convert::CheckReport& report, const formats::CenterlineTree& tree,
               const std::string& source);

}  // namespace lumen::app
