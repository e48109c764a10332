// SPDX-License-Identifier: Apache-2.0
// Replacement of vdb.cpp where lumen is built without OpenVDB.
#include "converters/base/error.h"
#include "converters/export/shared/grid_files.h"

namespace lumen::convert {

void requireVdb(const FieldWord& word) {
  throw unsupported(word("format") +
                    " vdb: this lumen was built without OpenVDB (on Debian libopenvdb-dev); it "
                    "writes the other formats");
}

std::string encodeVdb(const GridSource&, const Lattice&, const VdbOptions&, Progress&) {
  requireVdb({});
  return {};
}

}  // namespace lumen::convert
