// SPDX-License-Identifier: Apache-2.0
// Open ends and inlets of a case in answers.
#pragma once

#include <string>
#include <vector>

#include "converters/engine/answers/answer_text.h"
#include "converters/operations/ends_of.h"

namespace lumen::engine {

/// The rows of ends, numbered from 1 on in the order of `ends`.
Json openEndsJson(const std::vector<operations::OpenEnd>& ends,
                  const formats::CenterlineTree& tree);

/// The rows of the inlets among them.
Json inletsJson(const std::vector<operations::OpenEnd>& ends, const formats::CenterlineTree& tree);

/// All rows as a table.
std::string endTable(const std::vector<operations::OpenEnd>& ends,
                     const formats::CenterlineTree& tree);

/// The ends at which blood comes in: "2 leave the volume: a at (1.0, 2.0, 3.0), radius 2.31 mm; b at
/// ...; 5 trees begin within it". A long list is cut.
std::string inletsText(const std::vector<operations::OpenEnd>& ends,
                       const formats::CenterlineTree& tree);

}  // namespace lumen::engine
