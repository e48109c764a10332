// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <LumenSofa/BlobField.h>
#include <LumenSofa/MovingWall.h>
#include <LumenSofa/config.h>
#include <LumenSofa/points_on_nodes.h>
#include <blob_pose.h>
#include <sofa/core/behavior/MechanicalState.h>
#include <sofa/core/objectmodel/BaseObject.h>
#include <sofa/defaulttype/VecTypes.h>

namespace lumensofa {

/// A vessel that moves as its case states: the motion in the file of a BlobField takes the wall
/// along, whatever touches it. In a step from t to t + dt contacts see the wall at t, and the
/// displacement of each of its points until t + dt. `points`, such as those of a surface to be looked at, and a
/// `place`, such as that where an instrument enters, go along.
class LUMENSOFA_API BlobMotion : public sofa::core::objectmodel::BaseObject, public MovingWall {
public:
  SOFA_CLASS(BlobMotion, sofa::core::objectmodel::BaseObject);
  using Points = sofa::core::behavior::MechanicalState<sofa::defaulttype::Vec3Types>;

  void init() override;
  void handleEvent(sofa::core::objectmodel::Event* event) override;

  [[nodiscard]] State* state() const override { return nullptr; }
  Vec3 motionInStep(const Vec3& point, std::uint32_t cursor,
                    std::vector<FrameShare>& shares) const override;
  [[nodiscard]] double reach() const override { return m_reach; }

  sofa::Data<double> d_offset;
  sofa::Data<double> d_seconds;
  sofa::Data<Rigid3::Coord> d_place;
  sofa::Data<Rigid3::Coord> d_carriedPlace;
  sofa::SingleLink<BlobMotion, BlobField,
                   sofa::BaseLink::FLAG_STOREPATH | sofa::BaseLink::FLAG_STRONGLINK>
      l_field;
  sofa::SingleLink<BlobMotion, Points,
                   sofa::BaseLink::FLAG_STOREPATH | sofa::BaseLink::FLAG_STRONGLINK>
      l_points;

protected:
  BlobMotion();
  ~BlobMotion() override;

private:
  struct CloseMotion {
    void operator()(blob_motion* motion) const { blob_motion_close(motion); }
  };

  bool open();
  bool makePose(OwnedPose& pose);
  bool set(const OwnedPose& pose, double seconds);
  void beginStep(double dt);
  void endStep();
  void carryPlace();
  [[nodiscard]] double greatestMotion() const;

  std::unique_ptr<blob_motion, CloseMotion> m_motion;
  OwnedPose m_now, m_next;  ///< at the beginning and at the end of the step
  double m_nextTime = 0;    ///< s, of the motion: that of m_next
  double m_reach = 0;       ///< mm
  PointsOnNodes m_onNodes;
  std::uint32_t m_nodeOfPlace = 0;
  Vec3 m_restOfPlace;  ///< mm: the centre of that node at rest
};

}  // namespace lumensofa
