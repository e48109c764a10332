// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <LumenSofa/BlobField.h>
#include <LumenSofa/MovingWall.h>
#include <LumenSofa/config.h>
#include <blob_pose.h>
#include <sofa/core/objectmodel/BaseObject.h>

namespace lumensofa {

/// A vessel that moves: frames of a MechanicalObject carry the nodes of a case's tree, and with them
/// the wall of its BlobField. A node between two frames of a vessel follows both, by the distances
/// along it; a node that has frames on one side only follows the nearest as a rigid body; a tree
/// without a frame rests. The pose is set at the start of each step; contacts give their forces
/// back to the frames.
class LUMENSOFA_API BlobPose : public sofa::core::objectmodel::BaseObject, public MovingWall {
public:
  SOFA_CLASS(BlobPose, sofa::core::objectmodel::BaseObject);
  void init() override;
  void handleEvent(sofa::core::objectmodel::Event* event) override;

  /// The state of the frames; null before init() and without one.
  [[nodiscard]] State* state() const override { return l_state.get(); }
  Vec3 motionInStep(const Vec3& point, std::uint32_t cursor,
                    std::vector<FrameShare>& shares) const override;
  /// Frames follow slowly, so the wall of the beginning decides.
  [[nodiscard]] double reach() const override { return 0; }
  /// Sets the pose to the frames as they are.
  void update();
  /// Adds the frames that carry a point of the wall, whose node is `cursor`, to `shares`.
  void addShares(const Vec3& point, std::uint32_t cursor, std::vector<FrameShare>& shares) const;
  /// The motion, mm, of a point that `shares` carry while the frames move.
  static Vec3 motion(const FrameShare* shares, std::size_t count, const Vec3& point,
                     const Rigid3::VecCoord& from, const Rigid3::VecCoord& to);

  sofa::Data<sofa::type::vector<sofa::Index>> d_nodes;
  sofa::Data<double> d_tolerance;
  sofa::Data<double> d_displacement;
  sofa::SingleLink<BlobPose, BlobField,
                   sofa::BaseLink::FLAG_STOREPATH | sofa::BaseLink::FLAG_STRONGLINK>
      l_field;
  sofa::SingleLink<BlobPose, State,
                   sofa::BaseLink::FLAG_STOREPATH | sofa::BaseLink::FLAG_STRONGLINK>
      l_state;

protected:
  BlobPose();
  ~BlobPose() override;

private:
  static constexpr int kNone = -1;
  /// The frames of a node: the second is kNone where one carries it alone, both in a tree at rest.
  struct Carrier {
    int frame[2] = {kNone, kNone};
    double share = 0;  ///< of the second
  };

  bool hasValidNodes();
  void findCarriers();
  void findMovingFrames(const Rigid3::VecCoord& x);
  [[nodiscard]] blob_transform transformOf(std::uint32_t node, const Rigid3::VecCoord& x) const;

  OwnedPose m_pose;
  std::vector<Carrier> m_carriers;    ///< one for each node of the tree
  std::vector<Vec3> m_rest;           ///< mm: its centre at rest
  std::vector<blob_transform> m_set;  ///< as the pose has them
  Rigid3::VecCoord m_restFrames;
  Rigid3::VecCoord m_seenFrames;         ///< as they were when their nodes were looked at
  std::vector<double> m_levers;          ///< mm: how far the nodes of each frame are from it
  std::vector<char> m_moving;            ///< frames whose nodes may have moved by the tolerance
  std::vector<std::uint32_t> m_changed;  ///< nodes of the last step
  std::vector<blob_transform> m_buffer;
};

}  // namespace lumensofa
