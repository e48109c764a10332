// SPDX-License-Identifier: Apache-2.0
// lumen compare: a case against the truth.
#include "converters/judge/compare/compare.h"

#include <cmath>

#include "converters/engine/answers/answer_text.h"
#include "converters/engine/answers/check_answer.h"
#include "converters/engine/file_access.h"
#include "converters/engine/operations/operations.h"

namespace lumen::engine {

namespace {

std::vector<std::string> scoreRow(const std::string& label, const convert::CenterlineScore& score,
                                  const std::optional<convert::Quantiles>& wall) {
  const convert::Quantiles none{NAN, NAN, NAN};
  const convert::Quantiles& q = wall ? *wall : none;
  return {label,
          fixedText(score.overlap, 3),
          fixedText(score.overlapUntilFirstError, 3),
          fixedText(score.averageInside, 3),
          fixedText(score.assd, 3),
          fixedText(score.assdLimited, 3),
          fixedText(score.radiusBias, 3),
          fixedText(score.radiusRms, 3),
          fixedText(score.missed, 1),
          fixedText(score.falseLength, 1),
          fixedText(q.median, 3),
          fixedText(q.p90, 3),
          fixedText(q.max, 3)};
}

std::string comparisonText(const convert::Comparison& comparison) {
  std::vector<std::vector<std::string>> rows;
  rows.push_back({"branch", "OV", "OF", "AI", "ASSD", "limited", "bias", "RMS", "missed", "false",
                  "wall", "p90", "max"});
  for (const auto& branch : comparison.branches)
    rows.push_back(scoreRow(branch.label, branch.score, branch.wallDistance));
  rows.push_back(scoreRow("(all)", comparison.score, comparison.wallDistance));
  return alignColumns(rows) +
         "\nOV overlap, OF overlap until the first error, AI average inside; ASSD without and with "
         "the\ndistance limit; bias and RMS of the radius; missed and false length; distance of "
         "the "
         "wall:\nmedian, 90th percentile, greatest. Lengths in mm.\n";
}

class CompareCommand : public Command {
public:
  [[nodiscard]] std::string name() const override { return "compare"; }
  [[nodiscard]] std::string summary() const override { return "Score a case against the truth"; }
  [[nodiscard]] std::string example() const override {
    return "  lumen compare fork.lumen fork-truth.lumen --json";
  }

  void addRows(OptionTable& table) override {
    table.argument("CASE", &m_case, "The case to judge");
    table.argument("TRUTH", &m_truth, "The true case");
  }

  Answer run(const RunContext& context) override {
    const formats::Case found = readCase(m_case);
    const formats::Case truth = readCase(m_truth);
    const auto comparison = convert::compareCases(found, truth, context.progress);
    return {comparisonJson(comparison), comparisonText(comparison), 0, true};
  }

private:
  InputFile m_case, m_truth;
};

}  // namespace

std::unique_ptr<Command> makeCompareCommand() {
  return std::make_unique<CompareCommand>();
}

}  // namespace lumen::engine
