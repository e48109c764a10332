// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <LumenSofa/BlobField.h>
#include <LumenSofa/MovingWall.h>
#include <LumenSofa/beam_samples.h>
#include <LumenSofa/config.h>
#include <sofa/core/behavior/Constraint.h>

namespace lumensofa {

/// Contact with friction of an instrument's beams with the wall of a case. Samples along each beam
/// measure their distance to the wall; those near it get one row (normal), or three with friction,
/// of the Lagrangian constraints. Each sample has a cursor of its own, which follows the tree; when
/// beams are added or nodes placed anew, cursors go on by the abscissa along the instrument. Where a
/// BlobPose moves the wall, each row also holds the frames that carry the wall at the contact: the
/// solver finds forces for instrument and vessel at once, and the vessel's frames get the opposite
/// ones. Where a BlobMotion moves it, the wall takes the instrument along and gets no force.
class LUMENSOFA_API BeamBlobContact : public sofa::core::behavior::Constraint<Rigid3> {
public:
  SOFA_CLASS(BeamBlobContact, SOFA_TEMPLATE(sofa::core::behavior::Constraint, Rigid3));
  using ConstraintParams = sofa::core::ConstraintParams;
  using Constraint<Rigid3>::buildConstraintMatrix;
  using Constraint<Rigid3>::getConstraintViolation;
  using Constraint<Rigid3>::getConstraintResolution;

  void init() override;
  void bwdInit() override;

  void buildConstraintMatrix(const ConstraintParams* params,
                             sofa::core::MultiMatrixDerivId jacobians, unsigned int& row) override;
  void buildConstraintMatrix(const ConstraintParams* params, DataMatrixDeriv& jacobian,
                             unsigned int& row, const DataVecCoord& x) override;
  void getConstraintViolation(const ConstraintParams* params,
                              sofa::linearalgebra::BaseVector* violation, const DataVecCoord& x,
                              const DataVecDeriv& v) override;
  void getConstraintResolution(
      const ConstraintParams* params,
      std::vector<sofa::core::behavior::ConstraintResolution*>& resolutions,
      unsigned int& offset) override;
  void getConstraintInfo(const ConstraintParams* params, VecConstraintBlockInfo& blocks,
                         VecPersistentID& ids, VecConstCoord& positions, VecConstDeriv& directions,
                         VecConstArea& areas) override;

  /// The samples of the last step, and the nodes of the tree that they were in.
  [[nodiscard]] const std::vector<BeamSample>& samples() const { return m_samples; }
  [[nodiscard]] const std::vector<std::uint32_t>& cursors() const { return m_cursors; }

  /// The sum of the forces on the wall in the last step, friction included, mass times mm / s^2.
  [[nodiscard]] Vec3 forceOnWall() const;

  sofa::Data<double> d_radius;
  sofa::Data<double> d_friction;
  sofa::Data<unsigned int> d_samples;
  sofa::Data<double> d_alarmDistance;
  sofa::Data<unsigned int> d_contacts;
  sofa::Data<double> d_penetration;
  sofa::SingleLink<BeamBlobContact, BlobField,
                   sofa::BaseLink::FLAG_STOREPATH | sofa::BaseLink::FLAG_STRONGLINK>
      l_field;
  sofa::SingleLink<BeamBlobContact, Beams,
                   sofa::BaseLink::FLAG_STOREPATH | sofa::BaseLink::FLAG_STRONGLINK>
      l_interpolation;

protected:
  BeamBlobContact();
  ~BeamBlobContact() override = default;

private:
  /// A row (three with friction) of the constraints.
  struct Contact {
    std::size_t sample;
    Vec3 axis[3];            ///< the wall's inward normal and two tangents
    double violation[3];     ///< mm: the gap without contact, and the slide along the tangents
    Vec3 point;              ///< mm, of the wall
    std::size_t firstShare;  ///< in m_shares; they end where those of the next contact begin
  };

  bool hasValidNumbers();
  void findSamples();
  void carryOver();
  void startCursors();
  void findContacts();
  void forgetOtherForces();
  void predict();
  double gap(std::size_t sample) const;
  void addContact(std::size_t sample, const Vec3& normal);
  Vec3 motionOfWall(Contact& contact);
  std::size_t endOfShares(std::size_t contact) const;
  void addVesselRows(DataMatrixDeriv& jacobian) const;
  double shareOfSlide(double before, double after, double motion) const;

  // Kept from step to step, so that a step allocates nothing once they have grown.
  std::vector<BeamSample> m_samples;
  std::vector<double> m_abscissae;       ///< one for each of m_cursors and m_forces
  std::vector<std::uint32_t> m_cursors;  ///< cursors at the start of the step
  std::vector<Vec3> m_forces;  ///< last step's, in the world's frame: where the solver begins
  std::vector<std::size_t> m_nearest;
  std::vector<std::uint32_t> m_cursorBuffer;
  std::vector<Vec3> m_forceBuffer;
  std::vector<Vec3> m_start, m_next, m_free;  ///< mm; m_next: where a sample slides to
  std::vector<blob_sample> m_walls;           ///< wall at m_start, then at m_next
  std::vector<Contact> m_contacts;
  std::vector<FrameShare> m_shares;  ///< frames of a vessel that moves, contact by contact
  unsigned int m_firstRow = 0;
};

}  // namespace lumensofa
