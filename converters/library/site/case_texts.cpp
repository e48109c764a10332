// SPDX-License-Identifier: Apache-2.0
#include "converters/library/site/case_texts.h"

#include <cmath>

#include "converters/base/html.h"
#include "converters/base/number_text.h"
#include "converters/base/text.h"
#include "converters/library/library_file.h"

namespace lumen::convert {

std::string sideText(const std::string& laterality) {
  return laterality == "unknown" ? "side not stated" : laterality;
}

std::string modalityText(const std::string& modality) {
  if (modality == "XA") return "X-ray angiography";
  if (modality == "US") return "ultrasound";
  return modality == "other" ? "other source" : modality;
}

std::string galleryFigures(const CaseFigures& figures) {
  return "<span>" + counted(figures.branches, "vessel", "vessels") + "</span> · <span>" +
         shownFigure(figures.length) + " mm</span> · <span>radius " +
         shownFigure(figures.radiusMin) + "–" + shownFigure(figures.radiusMax) + " mm</span>";
}

std::string doiLink(const std::string& doi) {
  if (doi.empty()) return {};
  return element("a", name(doi),
                 "rel=\"external noreferrer\" href=\"https://doi.org/" + urlAddress(doi) + "\"")
      .html;
}

double rounded(double value) {
  constexpr double kSteps = 100;  // steps in one mm
  return std::isfinite(value) ? std::round(value * kSteps) / kSteps : 0;
}

std::string dataPath(const CaseRecord& record, const std::string& path) {
  return std::string(kPayload) + "/" + record.id + "/" + path;
}

std::string casePagePath(const std::string& id) {
  return "site/case/" + id + ".html";
}

}  // namespace lumen::convert
