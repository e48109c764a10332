// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/mujoco_text.h"

#include <algorithm>
#include <cstddef>

#include "converters/base/number_text.h"
#include "converters/io/mesh/mesh_parts.h"
#include "converters/io/mesh/write_plain.h"

namespace lumen::convert {

std::string mujocoNumbers(std::initializer_list<double> values) {
  std::string text;
  for (const double value : values) {
    if (!text.empty()) text += " ";
    text += numberText(value);
  }
  return text;
}

std::string mujocoNumbers(const Eigen::Vector3d& vector) {
  return mujocoNumbers({vector.x(), vector.y(), vector.z()});
}

std::vector<NamedEnd> plainlyNamed(std::vector<NamedEnd> ends) {
  std::vector<std::string> names;
  for (const NamedEnd& end : ends) names.push_back(end.name);
  names = distinct(names, openFoamWord);
  for (std::size_t k = 0; k < ends.size(); ++k) ends[k].name = names[k];
  return ends;
}

std::string endSite(const ExportFrame& frame, const NamedEnd& end) {
  return "<site name=\"" + end.name + "\" pos=\"" + mujocoNumbers(frame.position(end.position)) +
         "\" zaxis=\"" + mujocoNumbers(frame.direction(end.direction)) + "\" size=\"" +
         mujocoNumbers({frame.length(end.radius)}) + "\" rgba=\"0 0.6 0 0.3\"/>\n";
}

std::string stlInMetres(const SurfaceMesh& metres) {
  std::string bytes = encodeStl(metres, false);
  std::string head = "lumen " LUMEN_VERSION ", binary STL, m, SPACE=LPS (+x left, +y posterior)";
  head.resize(80, ' ');
  std::copy(head.begin(), head.end(), bytes.begin());
  return bytes;
}

}  // namespace lumen::convert
