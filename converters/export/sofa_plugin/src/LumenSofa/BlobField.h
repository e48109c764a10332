// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include <LumenSofa/config.h>
#include <LumenSofa/vessel_case.h>
#include <SofaImplicitField/components/geometry/ScalarField.h>
#include <sofa/core/objectmodel/DataFileName.h>

namespace lumensofa {

class MovingWall;

/// The wall of a case as a scalar field: f - T in mm, positive in the lumen, negative in the wall,
/// so its gradient points inwards. Lengths are millimetres in the frame of the case. `domain` is a
/// point's cursor (see blob.h): the node it was in, from which it moves along the tree only; -1 for
/// a point that is new. Without a case, values and gradients are zero.
class LUMENSOFA_API BlobField : public sofa::component::geometry::ScalarField {
public:
  SOFA_CLASS(BlobField, sofa::component::geometry::ScalarField);
  using Vec3d = sofa::type::Vec3d;
  using Mat3x3 = sofa::type::Mat3x3;

  void init() override;
  void reinit() override;

  /// Opens the case unless that was done. False, with a message and the scene stopped, if it cannot
  /// be used.
  bool load();

  /// The cursor of a point: located in the branch if `domain` is -1, otherwise moved along the
  /// tree.
  int getDomain(Vec3d& point, int domain) override;
  double getValue(Vec3d& point, int& domain) override;
  Vec3d getGradient(Vec3d& point, int& domain) override;
  void getHessian(Vec3d& point, Mat3x3& hessian) override;
  void getValueAndGradient(Vec3d& point, double& value, Vec3d& gradient, int& domain) override;
  /// The first crossing of the wall on the path from one end to the other. False if there is none.
  bool computeSegIntersection(Vec3d& from, Vec3d& to, Vec3d& crossing, int domain = -1) override;
  /// Moves the point to the nearest one of the wall.
  void projectPointonSurface(Vec3d& point, int domain = -1) override;

  using ScalarField::computeSegIntersection;
  using ScalarField::getGradient;
  using ScalarField::getValue;
  using ScalarField::getValueAndGradient;
  using ScalarField::projectPointonSurface;

  /// The model where it is: at rest, or posed. Null if there is none.
  [[nodiscard]] const blob_model* model() const {
    return m_posed != nullptr ? m_posed : m_vessel.model.get();
  }
  /// Component that moves the wall; null for a wall at rest.
  [[nodiscard]] MovingWall* mover() const { return m_mover; }
  void setMover(MovingWall* mover, const blob_model* posed) {
    m_mover = mover;
    m_posed = posed;
  }
  /// The file of the case, as SOFA finds it.
  [[nodiscard]] const std::string& path() const {
    const std::string& found = d_filename.getFullPath();
    return found.empty() ? d_filename.getValue() : found;
  }
  /// Flags of libblob's queries: BLOB_BLENDED or BLOB_LOCAL.
  [[nodiscard]] std::uint32_t flags() const { return m_flags; }
  /// Node at which a point that has no cursor begins; see load().
  [[nodiscard]] std::uint32_t locatePoint(const double point[3]) const {
    return locate(m_vessel, model(), point);
  }

  sofa::core::objectmodel::DataFileName d_filename;
  sofa::Data<std::string> d_domain;
  sofa::Data<std::string> d_branch;
  sofa::Data<sofa::Size> d_nodes;

protected:
  BlobField();
  ~BlobField() override = default;

private:
  std::uint32_t locateCursor(const Vec3d& point, int domain) const;

  VesselCase m_vessel;
  MovingWall* m_mover = nullptr;
  const blob_model* m_posed = nullptr;
  std::uint32_t m_flags = BLOB_BLENDED;
  bool m_tried = false;
};

}  // namespace lumensofa
