// SPDX-License-Identifier: Apache-2.0
// Replacement of register_rigid.cpp where lumen is built without ITK.
#include "converters/base/error.h"
#include "converters/stages/native/register_rigid.h"

namespace lumen::convert {

bool canRegister() {
  return false;
}

Eigen::Isometry3d registerRigid(const Volume&, const Volume&, std::span<const Eigen::Vector3d>,
                                const Eigen::Isometry3d&, const Progress&) {
  throw unsupported("this lumen was built without ITK (on Debian libinsighttoolkit5-dev)");
}

}  // namespace lumen::convert
