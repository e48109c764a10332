// SPDX-License-Identifier: Apache-2.0
// In place of vdb.cpp where lumen is built without OpenVDB.
#include "converters/common/error.h"
#include "converters/export/vdb.h"

namespace lumen::convert {

bool hasVdb() {
  return false;
}

std::string encodeVdb(const GridSource&, const Lattice&, const VdbOptions&, Progress&) {
  throw unsupported(
      "--format vdb: this lumen was built without OpenVDB (on Debian libopenvdb-dev); the other "
      "formats are there");
}

}  // namespace lumen::convert
