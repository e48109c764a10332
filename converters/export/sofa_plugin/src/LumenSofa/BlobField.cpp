// SPDX-License-Identifier: Apache-2.0
#include <LumenSofa/BlobField.h>
#include <LumenSofa/stop_scene.h>
#include <sofa/core/ObjectFactory.h>

#include "formats/container/printable.h"

namespace lumensofa {

BlobField::BlobField()
    : d_filename(initData(&d_filename, "filename", "case (.lumen) whose models are the wall")),
      d_domain(initData(&d_domain, std::string("blended"), "domain",
                        "'blended': the wall of the case, smooth along the tree; 'local': the "
                        "model of the point's node alone")),
      d_branch(initData(&d_branch, std::string(), "branch",
                        "label of the branch in which new points are looked for; empty: all")),
      d_nodes(initData(&d_nodes, sofa::Size(0), "nodes", "number of nodes of the tree")) {
  d_nodes.setReadOnly(true);
}

void BlobField::init() {
  load();
}

void BlobField::reinit() {
  if (m_mover != nullptr) {
    msg_error() << "a field that is moved stays as it is: load a scene with the other case";
    return stopScene(*this);
  }
  m_tried = false;
  load();
}

bool BlobField::load() {
  if (m_tried) return m_vessel.model != nullptr;
  m_tried = true;
  m_vessel = {};
  const std::string& domain = d_domain.getValue();
  if (domain != "blended" && domain != "local") {
    msg_error() << "domain is '" << lumen::formats::printable(domain)
                << "'; expected blended or local";
    stopScene(*this);
    return false;
  }
  m_flags = domain == "local" ? BLOB_LOCAL : BLOB_BLENDED;
  m_vessel = openVesselCase(path(), d_branch.getValue());
  if (m_vessel.model == nullptr) {
    msg_error() << m_vessel.problem;
    stopScene(*this);
    return false;
  }
  d_nodes.setValue(static_cast<sofa::Size>(m_vessel.nodeCount));
  d_componentState.setValue(sofa::core::objectmodel::ComponentState::Valid);
  return true;
}

// A domain that is no node is located by libblob, or here in the branch.
std::uint32_t BlobField::locateCursor(const Vec3d& point, int domain) const {
  if (domain >= 0 && static_cast<std::size_t>(domain) < m_vessel.nodeCount)
    return static_cast<std::uint32_t>(domain);
  return locate(m_vessel, model(), point.data());
}

int BlobField::getDomain(Vec3d& point, int domain) {
  if (model() == nullptr) return -1;
  return static_cast<int>(blob_cursor_follow(model(), point.data(), locateCursor(point, domain)));
}

void BlobField::getValueAndGradient(Vec3d& point, double& value, Vec3d& gradient, int& domain) {
  value = 0;
  gradient.clear();
  if (model() == nullptr) return;
  std::uint32_t cursor = locateCursor(point, domain);
  blob_sample sample;
  blob_query(model(), m_flags, point.data(), &cursor, &sample);
  domain = static_cast<int>(cursor);
  value = sample.value - m_vessel.isoLevel;
  gradient = Vec3d(sample.gradient[0], sample.gradient[1], sample.gradient[2]);
}

double BlobField::getValue(Vec3d& point, int& domain) {
  double value;
  Vec3d gradient;
  getValueAndGradient(point, value, gradient, domain);
  return value;
}

BlobField::Vec3d BlobField::getGradient(Vec3d& point, int& domain) {
  double value;
  Vec3d gradient;
  getValueAndGradient(point, value, gradient, domain);
  return gradient;
}

void BlobField::getHessian(Vec3d& point, Mat3x3& hessian) {
  hessian.clear();
  if (model() == nullptr) return;
  std::uint32_t cursor = locateCursor(point, -1);
  blob_hessian answer;
  blob_query_hessian(model(), m_flags, point.data(), &cursor, &answer);
  const double* h = answer.hessian;
  hessian = Mat3x3(Vec3d(h[0], h[3], h[4]), Vec3d(h[3], h[1], h[5]), Vec3d(h[4], h[5], h[2]));
}

bool BlobField::computeSegIntersection(Vec3d& from, Vec3d& to, Vec3d& crossing, int domain) {
  if (model() == nullptr) return false;
  std::uint32_t cursor = locateCursor(from, domain);
  blob_hit hit;
  blob_segment_hit(model(), m_flags, from.data(), to.data(), &cursor, 0, 0, &hit);
  if (hit.hit != 0) crossing = Vec3d(hit.point[0], hit.point[1], hit.point[2]);
  return hit.hit != 0;
}

void BlobField::projectPointonSurface(Vec3d& point, int domain) {
  if (model() == nullptr) return;
  std::uint32_t cursor = locateCursor(point, domain);
  blob_nearest_point nearest;
  blob_nearest(model(), m_flags, point.data(), &cursor, 0, 0, &nearest);
  point = Vec3d(nearest.point[0], nearest.point[1], nearest.point[2]);
}

void registerBlobField(sofa::core::ObjectFactory* factory) {
  factory->registerObjects(
      sofa::core::ObjectRegistrationData(
          "The wall of a vessel tree: the implicit models of a lumen case. Positive in the lumen; "
          "a point's domain is its node of the tree.")
          .add<BlobField>());
}

}  // namespace lumensofa
