// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/measures_of.h"

namespace lumen::operations {

CaseMeasures measuresOf(const formats::Case& value, const convert::MeasureOptions& options,
                        const Context& context) {
  CaseMeasures measures;
  context.progress.begin("measure", 0);
  measures.values = convert::measureCase(value, options, context.progress);
  context.progress.end();
  measures.tables = convert::measureTables(value, measures.values);
  return measures;
}

}  // namespace lumen::operations
