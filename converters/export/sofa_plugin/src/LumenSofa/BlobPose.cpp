// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <LumenSofa/BlobPose.h>
#include <LumenSofa/points_on_nodes.h>
#include <LumenSofa/stop_scene.h>
#include <sofa/core/ObjectFactory.h>
#include <sofa/helper/ScopedAdvancedTimer.h>
#include <sofa/simulation/AnimateBeginEvent.h>

namespace lumensofa {
namespace {

using sofa::type::Quat;
using sofa::type::Vec3;
using Coord = sofa::defaulttype::Rigid3Types::Coord;

// A point that a frame carries from where the frame was to where it is.
Vec3 carried(const Vec3& point, const Coord& from, const Coord& to) {
  return to.getCenter() +
         to.getOrientation().rotate(from.getOrientation().inverseRotate(point - from.getCenter()));
}

blob_transform transformBetween(const Vec3& point, const Coord& from, const Coord& to) {
  const Vec3 centre = carried(point, from, to);
  const Quat<double> turn = to.getOrientation() * from.getOrientation().inverse();
  return {{centre[0], centre[1], centre[2]}, {turn[0], turn[1], turn[2], turn[3]}, 1};
}

// Whether a node moved by less than `tolerance` mm, and its wall turned by less at `radius`.
bool isNear(const blob_transform& a, const blob_transform& b, double radius, double tolerance) {
  double turn = 0, sign = 0;
  for (int i = 0; i < 4; ++i) sign += a.rotation[i] * b.rotation[i];
  for (int i = 0; i < 4; ++i)
    turn = std::max(turn, std::abs(a.rotation[i] - std::copysign(1.0, sign) * b.rotation[i]));
  double most = 2 * turn * radius;
  for (int i = 0; i < 3; ++i) most = std::max(most, std::abs(a.centre[i] - b.centre[i]));
  return most < tolerance;
}

}  // namespace

BlobPose::BlobPose()
    : d_nodes(initData(&d_nodes, "nodes",
                       "node of the case's tree that each frame carries; empty: as many frames as "
                       "nodes, in their order")),
      d_tolerance(initData(&d_tolerance, 1e-3, "tolerance",
                           "mm: the wall does not follow a node that moved less since it did")),
      d_displacement(initData(&d_displacement, 0.0, "displacement",
                              "mm: how far the frame that moved most is from its place at rest")),
      l_field(initLink("field", "the wall that moves, a BlobField")),
      l_state(initLink("state", "the frames; by default those of the same node")) {
  d_displacement.setReadOnly(true);
  f_listening.setValue(true);
}

BlobPose::~BlobPose() {
  if (l_field && l_field->mover() == this) l_field->setMover(nullptr, nullptr);
}

bool BlobPose::hasValidNodes() {
  const std::size_t frames = l_state->getSize();
  const std::size_t nodes = l_field->d_nodes.getValue();
  const auto& listed = d_nodes.getValue();
  if (listed.empty() ? frames != nodes : frames != listed.size()) {
    msg_error() << "there are " << frames << " frames; expected one for each of the "
                << (listed.empty() ? nodes : listed.size())
                << (listed.empty() ? " nodes of the case" : " listed nodes");
    return false;
  }
  std::vector<bool> used(nodes, false);
  for (const sofa::Index node : listed) {
    if (node < nodes && !used[node]) {
      used[node] = true;
      continue;
    }
    msg_error() << "nodes has " << node << (node < nodes ? " twice" : "")
                << "; expected different numbers from 0 to " << nodes - 1;
    return false;
  }
  return true;
}

void BlobPose::init() {
  d_componentState.setValue(sofa::core::objectmodel::ComponentState::Loading);
  if (!l_state) l_state.set(getContext()->get<State>(sofa::core::objectmodel::BaseContext::Local));
  if (!l_field) {
    msg_error() << "no field: link a BlobField, such as field=\"@wall\"";
    return stopScene(*this);
  }
  if (!l_state) {
    msg_error() << "no frames: link a MechanicalObject of Rigid3d or put one in the same node";
    return stopScene(*this);
  }
  if (!l_field->load()) {
    msg_error() << "the field '" << l_field->getPathName() << "' is invalid, see its message";
    return stopScene(*this);
  }
  const double tolerance = d_tolerance.getValue();
  if (!std::isfinite(tolerance) || tolerance < 0) {
    msg_error() << "tolerance is " << tolerance << "; expected a number from 0";
    return stopScene(*this);
  }
  if (!hasValidNodes()) return stopScene(*this);
  if (l_field->mover() != nullptr) {
    msg_error() << "the field '" << l_field->getPathName()
                << "' is moved by another component; expected one for each field";
    return stopScene(*this);
  }
  blob_pose* pose = nullptr;
  const blob_status status = blob_pose_create(l_field->model(), nullptr, &pose);
  if (status != BLOB_OK) {
    msg_error() << "no pose: " << blob_status_text(status);
    return stopScene(*this);
  }
  m_pose.reset(pose);
  findCarriers();
  l_field->setMover(this, blob_pose_model(pose));
  d_componentState.setValue(sofa::core::objectmodel::ComponentState::Valid);
  update();
}

// In a case each parent comes before its children, so one pass from the roots finds the frame above
// each node, and one from the leaves the frame below it.
void BlobPose::findCarriers() {
  const blob_model* model = l_field->model();
  const std::size_t count = l_field->d_nodes.getValue();
  const auto& listed = d_nodes.getValue();
  m_restFrames = l_state->readRestPositions().ref();
  m_carriers.assign(count, {});
  m_rest.resize(count);
  m_set.resize(count);
  std::vector<int> own(count, kNone), above(count, kNone), below(count, kNone);
  std::vector<double> up(count, 0), down(count, 0);
  for (std::size_t k = 0; k < m_restFrames.size(); ++k)
    own[listed.empty() ? k : listed[k]] = static_cast<int>(k);
  const auto parentOf = [&](std::size_t i) {
    return blob_model_node(model, static_cast<std::uint32_t>(i)).parent;
  };
  for (std::size_t i = 0; i < count; ++i) {
    const blob_node node = blob_model_node(model, static_cast<std::uint32_t>(i));
    m_rest[i] = Vec3(node.centre[0], node.centre[1], node.centre[2]);
    m_set[i] = blob_pose_node(m_pose.get(), static_cast<std::uint32_t>(i));
    above[i] = below[i] = own[i];
    if (own[i] != kNone || node.parent < 0) continue;
    const auto parent = static_cast<std::size_t>(node.parent);
    above[i] = above[parent];
    up[i] = up[parent] + (m_rest[i] - m_rest[parent]).norm();
  }
  for (std::size_t i = count; i-- > 0;) {
    const std::int32_t parent = parentOf(i);
    if (parent < 0 || below[i] == kNone || below[static_cast<std::size_t>(parent)] != kNone)
      continue;
    below[static_cast<std::size_t>(parent)] = below[i];
    down[static_cast<std::size_t>(parent)] =
        down[i] + (m_rest[i] - m_rest[static_cast<std::size_t>(parent)]).norm();
  }
  for (std::size_t i = 0; i < count; ++i) {
    Carrier& carrier = m_carriers[i];
    carrier.frame[0] = above[i] != kNone ? above[i] : below[i];
    if (above[i] == kNone || below[i] == kNone || above[i] == below[i]) continue;
    carrier.frame[1] = below[i];
    carrier.share = up[i] / (up[i] + down[i]);
  }
  m_seenFrames = m_restFrames;
  m_moving.assign(m_restFrames.size(), 0);
  m_levers.assign(m_restFrames.size(), 0);
  for (std::size_t i = 0; i < count; ++i)
    for (const int frame : m_carriers[i].frame) {
      if (frame == kNone) continue;
      const auto k = static_cast<std::size_t>(frame);
      const double radius = blob_model_node(model, static_cast<std::uint32_t>(i)).radius;
      m_levers[k] =
          std::max(m_levers[k], radius + (m_rest[i] - m_restFrames[k].getCenter()).norm());
    }
}

// A frame that has moved too little to take any of its nodes out of the tolerance is passed over,
// with all of them.
void BlobPose::findMovingFrames(const Rigid3::VecCoord& x) {
  for (std::size_t k = 0; k < x.size(); ++k) {
    const Coord &now = x[k], &seen = m_seenFrames[k];
    const Quat<double> turn = now.getOrientation() * seen.getOrientation().inverse();
    const double sine = std::sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2]);
    const double most = (now.getCenter() - seen.getCenter()).norm() + 2 * sine * m_levers[k];
    m_moving[k] = most < 0.5 * d_tolerance.getValue() ? 0 : 1;
    if (m_moving[k] != 0) m_seenFrames[k] = now;
  }
}

blob_transform BlobPose::transformOf(std::uint32_t node, const Rigid3::VecCoord& x) const {
  const Carrier& carrier = m_carriers[node];
  const auto of = [&](int end) {
    const auto frame = static_cast<sofa::Size>(carrier.frame[end]);
    return transformBetween(m_rest[node], m_restFrames[frame], x[frame]);
  };
  const blob_transform first = of(0);
  if (carrier.frame[1] == kNone) return first;
  const blob_transform second = of(1);
  return blob_transform_between(&first, &second, carrier.share);
}

void BlobPose::update() {
  if (!isComponentStateValid()) return;
  SCOPED_TIMER("BlobPose");
  const auto& x = l_state->readPositions().ref();
  m_changed.clear();
  m_buffer.clear();
  const double tolerance = d_tolerance.getValue();
  findMovingFrames(x);
  const auto isMoving = [this](int frame) {
    return frame != kNone && m_moving[static_cast<std::size_t>(frame)] != 0;
  };
  for (std::uint32_t i = 0; i < m_carriers.size(); ++i) {
    if (!isMoving(m_carriers[i].frame[0]) && !isMoving(m_carriers[i].frame[1])) continue;
    const blob_transform now = transformOf(i, x);
    const double radius = blob_model_node(l_field->model(), i).radius;
    if (isNear(now, m_set[i], radius, tolerance)) continue;
    m_set[i] = now;
    m_changed.push_back(i);
    m_buffer.push_back(now);
  }
  double most = 0;
  for (sofa::Size k = 0; k < x.size(); ++k)
    most = std::max(most, (x[k].getCenter() - m_restFrames[k].getCenter()).norm());
  d_displacement.setValue(most);
  if (m_changed.empty()) return;
  const blob_status status =
      blob_pose_set(m_pose.get(), m_changed.size(), m_changed.data(), m_buffer.data(), nullptr);
  if (status == BLOB_OK) return;
  msg_error() << "the frames are no pose of the vessel: " << blob_status_text(status);
  stopScene(*this);
}

void BlobPose::handleEvent(sofa::core::objectmodel::Event* event) {
  if (sofa::simulation::AnimateBeginEvent::checkEventType(event)) update();
}

void BlobPose::addShares(const Vec3& point, std::uint32_t cursor,
                         std::vector<FrameShare>& shares) const {
  std::uint32_t nodes[kMostWeights];
  double weights[kMostWeights];
  const std::size_t found = blob_query_weights(l_field->model(), l_field->flags(), point.data(),
                                               &cursor, nodes, weights, kMostWeights);
  const std::size_t first = shares.size();
  const auto add = [&](int frame, double share) {
    if (frame == kNone || share == 0) return;
    for (std::size_t k = first; k < shares.size(); ++k)
      if (shares[k].frame == static_cast<sofa::Index>(frame)) {
        shares[k].share += share;
        return;
      }
    shares.push_back({static_cast<sofa::Index>(frame), share});
  };
  for (std::size_t k = 0; k < std::min(found, kMostWeights); ++k) {
    const Carrier& carrier = m_carriers[nodes[k]];
    add(carrier.frame[0], weights[k] * (1 - carrier.share));
    add(carrier.frame[1], weights[k] * carrier.share);
  }
  std::sort(shares.begin() + static_cast<std::ptrdiff_t>(first), shares.end(),
            [](const FrameShare& a, const FrameShare& b) { return a.frame < b.frame; });
}

// Frames that no solver moves have no free positions.
Vec3 BlobPose::motionInStep(const Vec3& point, std::uint32_t cursor,
                            std::vector<FrameShare>& shares) const {
  namespace access = sofa::core::vec_id::read_access;
  const std::size_t first = shares.size();
  addShares(point, cursor, shares);
  const auto& start = l_state->read(access::position)->getValue();
  const auto& free = l_state->read(access::freePosition)->getValue();
  if (free.size() != start.size()) return Vec3(0, 0, 0);
  return motion(shares.data() + first, shares.size() - first, point, start, free);
}

Vec3 BlobPose::motion(const FrameShare* shares, std::size_t count, const Vec3& point,
                      const Rigid3::VecCoord& from, const Rigid3::VecCoord& to) {
  Vec3 sum(0, 0, 0);
  for (std::size_t k = 0; k < count; ++k) {
    const sofa::Index frame = shares[k].frame;
    sum += (carried(point, from[frame], to[frame]) - point) * shares[k].share;
  }
  return sum;
}

void registerBlobPose(sofa::core::ObjectFactory* factory) {
  factory->registerObjects(
      sofa::core::ObjectRegistrationData(
          "Frames that carry the nodes of a lumen case's tree, and with them the wall of its "
          "BlobField.")
          .add<BlobPose>());
}

}  // namespace lumensofa
