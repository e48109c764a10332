// SPDX-License-Identifier: Apache-2.0
#include "converters/operations/xray_of.h"

#include "converters/operations/naming.h"

namespace lumen::operations {

convert::XrayImage xrayOf(const formats::Case& value, const std::string& name,
                          const convert::XrayOptions& options, const XrayScan& scan,
                          const Context& context) {
  Progress& progress = context.progress;
  progress.begin("X-ray", 0);
  std::optional<double> offset;
  if (scan.volume != nullptr)
    naming(scan.name, [&] { offset = convert::unitOffset(*scan.volume, progress); });
  convert::XrayImage image = naming(name, [&] {
    return convert::xrayOf(value, options, {scan.volume, offset.value_or(0)}, progress);
  });
  progress.end();
  return image;
}

}  // namespace lumen::operations
