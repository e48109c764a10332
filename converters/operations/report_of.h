// SPDX-License-Identifier: Apache-2.0
// All about a case as a page to print.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "converters/draw/report/report_page.h"
#include "converters/operations/check_of.h"
#include "converters/operations/context.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::operations {

/// A case and the bytes of its file.
struct ReportedCase {
  formats::Case value;  ///< the case on the page: that of the file, or that at a time of its motion
  std::span<const std::byte> file;  ///< a valid case in either encoding
  std::string name;                 ///< on the page: "head.lumen"
  std::string title;                ///< of the page; empty: the name
};

/// A volume beside a case.
struct ReportedVolume {
  convert::Volume voxels;
  std::string name;                   ///< on the page: "head.nrrd"
  std::optional<double> pointSpread;  ///< as CheckOptions has it
  std::optional<CheckNames> names;    ///< in messages, as CheckOptions has them
};

struct Page {
  std::string html;            ///< one file that loads nothing; equal inputs give equal bytes
  convert::ReportFacts facts;  ///< all that is on it
};

/// The page of a case: pictures, tables and plots; with a volume also its projections, and how far
/// the case agrees with it. Remarks are on the page; those of checked() are warnings, too. Takes
/// seconds for the pictures and the closed surface, on all threads. Throws Error(InvalidInput) if
/// all voxels are equal or no node of a case with models lies in the volume, and Error(Cancelled).
Page reportOf(ReportedCase source, const std::optional<ReportedVolume>& volume,
              const Context& context);

}  // namespace lumen::operations
