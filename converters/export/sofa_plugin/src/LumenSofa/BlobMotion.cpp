// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <LumenSofa/BlobMotion.h>
#include <LumenSofa/stop_scene.h>
#include <sofa/core/ObjectFactory.h>
#include <sofa/helper/ScopedAdvancedTimer.h>
#include <sofa/simulation/AnimateBeginEvent.h>
#include <sofa/simulation/AnimateEndEvent.h>

namespace lumensofa {

BlobMotion::BlobMotion()
    : d_offset(initData(&d_offset, 0.0, "offset",
                        "s: time of the motion at which the scene's time is zero")),
      d_seconds(
          initData(&d_seconds, 0.0, "seconds",
                   "s: time of the motion at which the wall is, at the end of the last step")),
      d_place(initData(&d_place, "place",
                       "mm and a quaternion: a place of the vessel at rest, such as that where an "
                       "instrument enters")),
      d_carriedPlace(initData(&d_carriedPlace, "carriedPlace",
                              "where that place is at the end of the step, mm and a quaternion")),
      l_field(initLink("field", "the wall that moves, a BlobField whose case has a motion")),
      l_points(initLink("points",
                        "points that go along, such as those of a surface to be seen; at "
                        "rest where the case is")) {
  d_seconds.setReadOnly(true);
  d_carriedPlace.setReadOnly(true);
  f_listening.setValue(true);
}

BlobMotion::~BlobMotion() {
  if (l_field && l_field->mover() == this) l_field->setMover(nullptr, nullptr);
}

bool BlobMotion::makePose(OwnedPose& pose) {
  blob_pose* made = nullptr;
  const blob_status status = blob_pose_create(l_field->model(), nullptr, &made);
  pose.reset(made);
  if (status != BLOB_OK) msg_error() << "no pose: " << blob_status_text(status);
  return status == BLOB_OK;
}

bool BlobMotion::open() {
  if (!l_field) {
    msg_error() << "no field: link a BlobField, such as field=\"@wall\"";
    return false;
  }
  if (!l_field->load()) {
    msg_error() << "the field '" << l_field->getPathName() << "' is invalid, see its message";
    return false;
  }
  if (l_field->mover() != nullptr) {
    msg_error() << "the field '" << l_field->getPathName()
                << "' is moved by another component; expected one for each field";
    return false;
  }
  char message[512] = "";
  blob_open_def def = blob_open_def_default();
  def.message = message;
  def.message_size = sizeof message;
  blob_motion* motion = nullptr;
  const blob_status status = blob_motion_open(l_field->path().c_str(), &def, &motion);
  m_motion.reset(motion);
  if (status == BLOB_OK) return makePose(m_now) && makePose(m_next);
  if (status == BLOB_ERROR_NO_MOTION)
    msg_error() << "'" << l_field->path()
                << "' has no motion: 'lumen motion' makes one from images";
  else
    msg_error() << "'" << l_field->path() << "': " << message;
  return false;
}

void BlobMotion::init() {
  d_componentState.setValue(sofa::core::objectmodel::ComponentState::Loading);
  if (!open()) return stopScene(*this);
  if (l_points)
    m_onNodes =
        PointsOnNodes(l_field->model(), l_field->flags(), l_points->readRestPositions().ref());
  m_nodeOfPlace = l_field->locatePoint(d_place.getValue().getCenter().data());
  m_restOfPlace = Vec3(blob_model_node(l_field->model(), m_nodeOfPlace).centre);
  m_nextTime = getContext()->getTime() + d_offset.getValue();
  if (!set(m_now, m_nextTime) || !set(m_next, m_nextTime)) return;
  l_field->setMover(this, blob_pose_model(m_now.get()));
  d_componentState.setValue(sofa::core::objectmodel::ComponentState::Valid);
  carryPlace();
  endStep();
}

bool BlobMotion::set(const OwnedPose& pose, double seconds) {
  const blob_status status = blob_pose_set_time(pose.get(), m_motion.get(), seconds, nullptr);
  if (status == BLOB_OK) return true;
  msg_error() << "no pose at " << seconds << " s: " << blob_status_text(status);
  stopScene(*this);
  return false;
}

// An upper bound on the way of a wall point: that of a node's centre, and what its turn and its
// factor add at twice its radius, as far as surroundings reach that matter to a contact.
double BlobMotion::greatestMotion() const {
  constexpr double kSurroundings = 2;
  double most = 0;
  const auto count = static_cast<std::uint32_t>(l_field->d_nodes.getValue());
  for (std::uint32_t i = 0; i < count; ++i) {
    const blob_transform a = blob_pose_node(m_now.get(), i), b = blob_pose_node(m_next.get(), i);
    double way = 0, dot = 0;
    for (int k = 0; k < 3; ++k) way += (a.centre[k] - b.centre[k]) * (a.centre[k] - b.centre[k]);
    for (int k = 0; k < 4; ++k) dot += a.rotation[k] * b.rotation[k];
    const double turn = 2 * std::sqrt(std::max(0.0, 1 - dot * dot));  // at least its chord
    const double radius = kSurroundings * blob_model_node(l_field->model(), i).radius;
    most = std::max(most, std::sqrt(way) + radius * (turn + std::abs(b.factor / a.factor - 1)));
  }
  return most;
}

// The end of a step is the beginning of the next one, unless the scene's time has jumped.
void BlobMotion::beginStep(double dt) {
  if (!isComponentStateValid()) return;
  SCOPED_TIMER("BlobMotion");
  const double now = getContext()->getTime() + d_offset.getValue();
  if (std::abs(now - m_nextTime) < 1e-9 * (1 + std::abs(now)))
    m_now.swap(m_next);
  else if (!set(m_now, now))
    return;
  m_nextTime = now + dt;
  if (!set(m_next, m_nextTime)) return;
  l_field->setMover(this, blob_pose_model(m_now.get()));
  m_reach = greatestMotion();
  carryPlace();
}

// A place rides on its node as on a rigid body that grows.
void BlobMotion::carryPlace() {
  if (!d_place.isSet()) return;
  const blob_transform to = blob_pose_node(m_next.get(), m_nodeOfPlace);
  const double* q = to.rotation;
  const sofa::type::Quat<double> turn(q[0], q[1], q[2], q[3]);
  const Rigid3::Coord& rest = d_place.getValue();
  const Vec3 arm = (rest.getCenter() - m_restOfPlace) * to.factor;
  d_carriedPlace.setValue({Vec3(to.centre) + turn.rotate(arm), turn * rest.getOrientation()});
}

void BlobMotion::endStep() {
  if (!isComponentStateValid()) return;
  d_seconds.setValue(m_nextTime);
  if (!l_points) return;
  auto points = l_points->writePositions();
  if (points.size() == m_onNodes.size()) m_onNodes.move(m_next.get(), points.wref());
}

void BlobMotion::handleEvent(sofa::core::objectmodel::Event* event) {
  using sofa::simulation::AnimateBeginEvent;
  if (AnimateBeginEvent::checkEventType(event))
    beginStep(static_cast<AnimateBeginEvent*>(event)->getDt());
  else if (sofa::simulation::AnimateEndEvent::checkEventType(event))
    endStep();
}

// blob_pose_velocity() asks for the pose before: with the one after and a step of -1 it gives the
// way there.
MovingWall::Vec3 BlobMotion::motionInStep(const Vec3& point, std::uint32_t cursor,
                                          std::vector<FrameShare>&) const {
  double way[3];
  blob_pose_velocity(m_now.get(), m_next.get(), -1, l_field->flags(), point.data(), &cursor, way);
  return Vec3(way);
}

void registerBlobMotion(sofa::core::ObjectFactory* factory) {
  factory->registerObjects(
      sofa::core::ObjectRegistrationData(
          "Moves the wall of a BlobField as the motion in its case states, and points with it.")
          .add<BlobMotion>());
}

}  // namespace lumensofa
