// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/check_of.h"

#include <utility>

#include "converters/base/warning.h"
#include "converters/judge/facts/reachable.h"
#include "converters/operations/naming.h"

namespace lumen::operations {

namespace {

void warnOfCase(const CheckNames& names, const std::optional<std::string>& words,
                Progress& progress) {
  if (words) warn(progress, about(names.value, {WarningCode::CaseOtherVolume, *words}));
}

}  // namespace

convert::SourceRelation relationOf(const formats::Case& value, const formats::SourceVolume& source,
                                   const std::optional<CheckNames>& names, const Context& context) {
  convert::SourceRelation relation = convert::sourceRelation(source, value.metadata);
  if (names) warnOfCase(*names, relation.warning(names->volume), context.progress);
  return relation;
}

Checked checked(const formats::Case& value, const convert::Volume& volume,
                const formats::SourceVolume& source, const CheckOptions& options,
                const Context& context) {
  Checked made;
  made.source = relationOf(value, source, options.names, context);
  convert::EdgeOptions edges = convert::recordedEdgeOptions(value);
  if (options.pointSpread) edges.pointSpread = *options.pointSpread;
  const auto check = [&] { return convert::checkCase(volume, value, edges, context.progress); };
  convert::CheckResult result = options.names ? naming(options.names->both, check) : check();
  made.report = std::move(result.report);
  made.lumen = std::move(result.lumen);
  if (options.names)
    warnOfCase(*options.names, convert::outsideWarning(made.report, options.names->volume),
               context.progress);
  if (options.profile)
    made.verdict = convert::judgeCase(*options.profile, value, made.report,
                                      convert::measureReach(value, context.progress));
  return made;
}

}  // namespace lumen::operations
