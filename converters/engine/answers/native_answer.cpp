// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/answers/native_answer.h"

#include "converters/base/number_text.h"
#include "converters/base/text.h"
#include "formats/container/printable.h"

namespace lumen::engine {
namespace {

std::string millilitres(double cubicMillimetres) {
  return fixedText(cubicMillimetres / 1000, 1) + " ml";
}

}  // namespace

Json nativeJson(const std::optional<convert::NativeReport>& report) {
  if (!report) return nullptr;
  Json pieces = Json::array();
  for (const convert::NativePiece& piece : report->pieces)
    pieces.push_back({{"bone_ml", piece.volume / 1000},
                      {"shift_mm", {piece.shift[0], piece.shift[1], piece.shift[2]}},
                      {"rotation_degrees", piece.rotation},
                      {"residual_mm", piece.residual},
                      {"residual_hu", piece.difference}});
  return {{"name", report->name},
          {"pieces", std::move(pieces)},
          {"unmatched_ml", report->unmatched / 1000},
          {"outside_ml", report->outside / 1000},
          {"doubtful_ml", report->doubtful / 1000}};
}

std::string nativeLines(const std::optional<convert::NativeReport>& report) {
  if (!report) return {};
  std::string text = formats::printable(report->name) + ": bone in " +
                     counted(report->pieces.size(), "piece", "pieces") + " is subtracted, " +
                     millilitres(report->doubtful) + " at its edges is masked, " +
                     millilitres(report->unmatched) + " match nothing\n";
  for (const convert::NativePiece& piece : report->pieces)
    text += "  " + millilitres(piece.volume) + " moved by " + fixedText(piece.shift.norm(), 2) +
            " mm and " + fixedText(piece.rotation, 2) + " degrees; " +
            fixedText(piece.residual, 2) + " mm and " + fixedText(piece.difference, 0) +
            " HU are left\n";
  return text;
}

}  // namespace lumen::engine
