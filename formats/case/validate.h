// SPDX-License-Identifier: Apache-2.0
// The rules that a case obeys whatever its file format; see spec/lumen.md, "Rules of the model".
#pragma once

#include "formats/case/case.h"
#include "formats/container/expected.h"

namespace lumen::formats {

/// Success, or the first rule of the format that `value` breaks (sizes, ranges, references,
/// finiteness, labels).
Status validate(const Case& value);

/// Checks the rules of the model, the metadata, the node arrays and the other chunks.
void checkCase(const Case& value, IssueList& issues);

/// Drops the other chunks that are wrong once nodes, points or models have changed.
void dropDependentChunks(Case& value);

}  // namespace lumen::formats
