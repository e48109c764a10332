// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <LumenSofa/config.h>
#include <blob_pose.h>
#include <sofa/core/behavior/MechanicalState.h>
#include <sofa/defaulttype/RigidTypes.h>

namespace lumensofa {

struct ClosePose {
  void operator()(blob_pose* pose) const { blob_pose_close(pose); }
};
using OwnedPose = std::unique_ptr<blob_pose, ClosePose>;

/// A frame that carries a point of the wall, and its share of the point: the shares of a point add
/// up to 1. A force F at the point X is, on this frame, the force share * F and the torque
/// (X - frame) x share * F.
struct FrameShare {
  sofa::Index frame = 0;
  double share = 0;
};

/// The side of a component that moves the wall of a BlobField which contacts see.
class LUMENSOFA_API MovingWall {
public:
  using Rigid3 = sofa::defaulttype::Rigid3Types;
  using State = sofa::core::behavior::MechanicalState<Rigid3>;
  using Vec3 = sofa::type::Vec3;

  MovingWall() = default;
  MovingWall(const MovingWall&) = delete;
  MovingWall& operator=(const MovingWall&) = delete;

  /// The frames that carry the wall, which contacts push; null for a wall that no force moves.
  [[nodiscard]] virtual State* state() const = 0;
  /// Returns the displacement, mm, of a point of the wall in this step without contact; its cursor
  /// is that in the field's model. Adds the frames that carry the point to `shares`.
  virtual Vec3 motionInStep(const Vec3& point, std::uint32_t cursor,
                            std::vector<FrameShare>& shares) const = 0;
  /// mm: contacts are looked for this much farther off, as the wall may come nearer in a step.
  [[nodiscard]] virtual double reach() const = 0;

protected:
  virtual ~MovingWall() = default;
};

}  // namespace lumensofa
