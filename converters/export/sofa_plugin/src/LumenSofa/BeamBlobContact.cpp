// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <LumenSofa/BeamBlobContact.h>
#include <LumenSofa/friction_from_last_step.h>
#include <LumenSofa/stop_scene.h>
#include <sofa/core/ConstraintParams.h>
#include <sofa/core/ObjectFactory.h>
#include <sofa/helper/AdvancedTimer.h>
#include <sofa/helper/ScopedAdvancedTimer.h>
#include <sofa/linearalgebra/BaseVector.h>

namespace lumensofa {
namespace {

constexpr unsigned kMaxSamples = 64;

// libblob's points are packed triples of doubles.
static_assert(sizeof(Vec3) == 3 * sizeof(double));
const double (*packed(const std::vector<Vec3>& points))[3] {
  return reinterpret_cast<const double(*)[3]>(points.data());
}

Vec3 inwards(const blob_sample& wall) {
  return Vec3(-wall.normal[0], -wall.normal[1], -wall.normal[2]);
}

// Two tangents that change little when the normal does: from the coordinate axis that it is least
// along.
void setTangents(Vec3 axis[3]) {
  const Vec3& n = axis[0];
  sofa::Size least = 0;
  for (sofa::Size i = 1; i < 3; ++i)
    if (std::abs(n[i]) < std::abs(n[least])) least = i;
  Vec3 other(0, 0, 0);
  other[least] = 1;
  axis[1] = sofa::type::cross(n, other);
  axis[1].normalize();
  axis[2] = sofa::type::cross(n, axis[1]);
}

}  // namespace

BeamBlobContact::BeamBlobContact()
    : d_radius(initData(&d_radius, 0.0, "radius",
                        "radius of the instrument, mm; 0: of each beam's section")),
      d_friction(initData(&d_friction, 0.0, "friction", "Coulomb's coefficient of friction")),
      d_samples(initData(&d_samples, 3u, "samples", "points along each beam")),
      d_alarmDistance(initData(&d_alarmDistance, 0.5, "alarmDistance",
                               "mm: samples nearer to the wall than this are constrained")),
      d_contacts(initData(&d_contacts, 0u, "contacts", "number of constraints of the last step")),
      d_penetration(initData(&d_penetration, 0.0, "penetration",
                             "mm: how deep the instrument was in the wall at its deepest sample, "
                             "at the start of the last step")),
      l_field(initLink("field", "the wall, a BlobField")),
      l_interpolation(initLink("interpolation", "the beams; by default those of the same node")) {
  d_contacts.setReadOnly(true);
  d_penetration.setReadOnly(true);
}

bool BeamBlobContact::hasValidNumbers() {
  const unsigned samples = d_samples.getValue();
  if (samples < 1 || samples > kMaxSamples) {
    msg_error() << "samples is " << samples << "; expected 1 to " << kMaxSamples;
    return false;
  }
  for (const sofa::Data<double>* data : {&d_radius, &d_friction, &d_alarmDistance}) {
    const double value = data->getValue();
    if (std::isfinite(value) && value >= 0) continue;
    msg_error() << data->getName() << " is " << value << "; expected a number from 0";
    return false;
  }
  return true;
}

void BeamBlobContact::init() {
  Constraint<Rigid3>::init();
  d_componentState.setValue(sofa::core::objectmodel::ComponentState::Loading);
  if (!l_interpolation)
    l_interpolation.set(getContext()->get<Beams>(sofa::core::objectmodel::BaseContext::Local));
  if (!hasValidNumbers()) return stopScene(*this);
  if (!l_interpolation) {
    msg_error() << "no beams: link a WireBeamInterpolation or put one in the same node";
    return stopScene(*this);
  }
  if (!l_field) {
    msg_error() << "no field: link a BlobField, such as field=\"@/vessel/wall\"";
    return stopScene(*this);
  }
  if (!l_field->load()) {
    msg_error() << "the field '" << l_field->getPathName() << "' is invalid, see its message";
    return stopScene(*this);
  }
  d_componentState.setValue(sofa::core::objectmodel::ComponentState::Valid);
}

// Without a state there is nothing to constrain, which SOFA itself reports.
void BeamBlobContact::bwdInit() {
  if (getMState() == nullptr && isComponentStateValid()) stopScene(*this);
}

void BeamBlobContact::startCursors() {
  std::uint32_t cursor = BLOB_NOWHERE;
  for (std::size_t i = 0; i < m_samples.size(); ++i) {
    const double* point = m_start[i].data();
    cursor = cursor == BLOB_NOWHERE ? l_field->locatePoint(point)
                                    : blob_cursor_follow(l_field->model(), point, cursor);
    m_cursors[i] = cursor;
  }
}

// Cursors and forces go to the samples that are nearest along the instrument.
void BeamBlobContact::carryOver() {
  nearestAlong(m_abscissae, m_samples, m_nearest);
  m_cursorBuffer.resize(m_samples.size());
  m_forceBuffer.resize(m_samples.size());
  for (std::size_t i = 0; i < m_samples.size(); ++i) {
    m_cursorBuffer[i] = m_cursors[m_nearest[i]];
    m_forceBuffer[i] = m_forces[m_nearest[i]];
  }
  m_cursors.swap(m_cursorBuffer);
  m_forces.swap(m_forceBuffer);
}

void BeamBlobContact::findSamples() {
  layOutSamples(*l_interpolation, d_samples.getValue(), d_radius.getValue(), m_samples);
  const auto& start = getMState()->read(sofa::core::vec_id::read_access::position)->getValue();
  const auto& free = getMState()->read(sofa::core::vec_id::read_access::freePosition)->getValue();
  placeSamples(*l_interpolation, free, false, m_samples, m_free);
  placeSamples(*l_interpolation, start, true, m_samples, m_start);
  if (m_abscissae.empty()) {
    m_cursors.assign(m_samples.size(), BLOB_NOWHERE);
    m_forces.assign(m_samples.size(), Vec3(0, 0, 0));
    startCursors();
  } else {
    carryOver();
  }
  m_abscissae.resize(m_samples.size());
  for (std::size_t i = 0; i < m_samples.size(); ++i) m_abscissae[i] = m_samples[i].abscissa;
}

// The wall is linearised where each sample comes to if the instrument slides on along itself as in
// the last step: at the sample itself, a bump would be met too high. Its sideways motion is not
// known before: its free position is far away, as the instrument springs towards its rest shape
// without contact, and a tip flicks to and fro.
void BeamBlobContact::findContacts() {
  const std::size_t count = m_samples.size();
  const blob_model* model = l_field->model();
  m_walls.resize(count);
  blob_query_many(model, l_field->flags(), count, packed(m_start), m_cursors.data(),
                  m_walls.data());
  double deepest = 0;
  for (std::size_t i = 0; i < count; ++i) deepest = std::max(deepest, -gap(i));
  d_penetration.setValue(deepest);
  predict();
  m_cursorBuffer.assign(m_cursors.begin(), m_cursors.end());
  blob_query_many(model, l_field->flags(), count, packed(m_next), m_cursorBuffer.data(),
                  m_walls.data());
  m_contacts.clear();
  m_shares.clear();
  const double alarm =
      d_alarmDistance.getValue() + (l_field->mover() != nullptr ? l_field->mover()->reach() : 0);
  for (std::size_t i = 0; i < count; ++i) {
    // a point that is not finite or has no normal cannot be held
    const Vec3 normal = inwards(m_walls[i]);
    if (gap(i) < alarm && normal.norm2() > 0.5) addContact(i, normal);
  }
  d_contacts.setValue(static_cast<unsigned>(m_contacts.size()));
  forgetOtherForces();
}

double BeamBlobContact::gap(std::size_t sample) const {
  return -m_walls[sample].distance - m_samples[sample].radius;
}

// A sample's velocity is the transpose of its Jacobian times those of its frames: v + w x arm.
void BeamBlobContact::predict() {
  const auto& velocity = getMState()->read(sofa::core::vec_id::read_access::velocity)->getValue();
  const double dt = getContext()->getDt();
  m_next.resize(m_samples.size());
  for (std::size_t i = 0; i < m_samples.size(); ++i) {
    const BeamSample& sample = m_samples[i];
    Vec3 motion(0, 0, 0);
    for (int end = 0; end < 2; ++end) {
      const Deriv& v = velocity[sample.node[end]];
      motion += getVCenter(v) * sample.weight[end] +
                sofa::type::cross(getVOrientation(v), sample.arm[end]);
    }
    m_next[i] = m_start[i] + sample.tangent * (sample.tangent * motion * dt);
  }
}

void BeamBlobContact::forgetOtherForces() {
  auto contact = m_contacts.begin();
  for (std::size_t i = 0; i < m_forces.size(); ++i)
    if (contact != m_contacts.end() && contact->sample == i)
      ++contact;
    else
      m_forces[i].clear();
}

// Share of the step's slide that is in touch: all of it for a sample that rests on the wall, the
// part after the first touch for one that gets there, none for one that does not.
double BeamBlobContact::shareOfSlide(double before, double after, double motion) const {
  constexpr double kResting = 0.01;
  if (before <= kResting * motion) return 1;
  return after < 0 ? after / (after - before) : 0;
}

// The way, mm, that the wall goes without contact where it moves; it notes the frames that carry it.
Vec3 BeamBlobContact::motionOfWall(Contact& contact) {
  contact.firstShare = m_shares.size();
  const MovingWall* mover = l_field->mover();
  if (mover == nullptr) return Vec3(0, 0, 0);
  return mover->motionInStep(contact.point, m_cursorBuffer[contact.sample], m_shares);
}

std::size_t BeamBlobContact::endOfShares(std::size_t contact) const {
  return contact + 1 < m_contacts.size() ? m_contacts[contact + 1].firstShare : m_shares.size();
}

void BeamBlobContact::addContact(std::size_t sample, const Vec3& normal) {
  Contact contact;
  contact.sample = sample;
  contact.point = m_next[sample] + normal * m_walls[sample].distance;
  const Vec3 wall = motionOfWall(contact);
  const double before = gap(sample) + normal * (m_start[sample] - m_next[sample]);
  const double after = gap(sample) + normal * (m_free[sample] - wall - m_next[sample]);
  const Vec3 motion = m_free[sample] - wall - m_start[sample];
  contact.axis[0] = normal;
  setTangents(contact.axis);
  const double share = shareOfSlide(before, after, motion.norm());
  contact.violation[0] = after;
  contact.violation[1] = contact.axis[1] * motion * share;
  contact.violation[2] = contact.axis[2] * motion * share;
  m_contacts.push_back(contact);
}

void BeamBlobContact::buildConstraintMatrix(const ConstraintParams* params,
                                            sofa::core::MultiMatrixDerivId jacobians,
                                            unsigned int& row) {
  Constraint<Rigid3>::buildConstraintMatrix(params, jacobians, row);
  if (m_contacts.empty() || l_field->mover() == nullptr) return;
  MovingWall::State* const vessel = l_field->mover()->state();
  if (vessel != nullptr) addVesselRows(*jacobians[vessel].write());
}

// The rows of the contacts, seen from the vessel: the opposite of the instrument's.
void BeamBlobContact::addVesselRows(DataMatrixDeriv& jacobian) const {
  namespace access = sofa::core::vec_id::read_access;
  const auto& frames = l_field->mover()->state()->read(access::position)->getValue();
  const int rows = d_friction.getValue() > 0 ? 3 : 1;
  auto matrix = sofa::helper::getWriteAccessor(jacobian);
  auto row = static_cast<int>(m_firstRow);
  for (std::size_t i = 0; i < m_contacts.size(); ++i)
    for (int k = 0; k < rows; ++k) {
      auto line = matrix->writeLine(row++);
      const Contact& contact = m_contacts[i];
      for (std::size_t n = contact.firstShare; n < endOfShares(i); ++n) {
        const Vec3 force = contact.axis[k] * -m_shares[n].share;
        const Vec3 arm = contact.point - frames[m_shares[n].frame].getCenter();
        line.addCol(static_cast<int>(m_shares[n].frame),
                    Deriv(force, sofa::type::cross(arm, force)));
      }
    }
}

void BeamBlobContact::buildConstraintMatrix(const ConstraintParams*, DataMatrixDeriv& jacobian,
                                            unsigned int& row, const DataVecCoord&) {
  m_firstRow = row;
  m_contacts.clear();
  if (!isComponentStateValid()) return;
  SCOPED_TIMER("BeamBlobContact");
  findSamples();
  findContacts();
  const int rows = d_friction.getValue() > 0 ? 3 : 1;
  auto matrix = sofa::helper::getWriteAccessor(jacobian);
  for (const Contact& contact : m_contacts) {
    const BeamSample& sample = m_samples[contact.sample];
    for (int k = 0; k < rows; ++k) {
      auto line = matrix->writeLine(static_cast<int>(row++));
      const Vec3& direction = contact.axis[k];
      for (int end = 0; end < 2; ++end)
        line.addCol(
            static_cast<int>(sample.node[end]),
            Deriv(direction * sample.weight[end], sofa::type::cross(sample.arm[end], direction)));
    }
  }
}

void BeamBlobContact::getConstraintViolation(const ConstraintParams* params,
                                             sofa::linearalgebra::BaseVector* violation,
                                             const DataVecCoord&, const DataVecDeriv&) {
  const bool velocity = params->constOrder() == sofa::core::ConstraintOrder::VEL ||
                        params->constOrder() == sofa::core::ConstraintOrder::ACC;
  const double unit = velocity ? 1 / getContext()->getDt() : 1;
  const int rows = d_friction.getValue() > 0 ? 3 : 1;
  auto row = static_cast<sofa::SignedIndex>(m_firstRow);
  for (const Contact& contact : m_contacts)
    for (int k = 0; k < rows; ++k) violation->set(row++, contact.violation[k] * unit);
}

void BeamBlobContact::getConstraintResolution(
    const ConstraintParams*, std::vector<sofa::core::behavior::ConstraintResolution*>& resolutions,
    unsigned int& offset) {
  const double friction = d_friction.getValue();
  for (const Contact& contact : m_contacts) {
    Vec3& force = m_forces[contact.sample];
    // SOFA deletes it after the step
    resolutions[offset] = newResolution(friction, contact.axis, force);
    offset += resolutions[offset]->getNbLines();
  }
}

Vec3 BeamBlobContact::forceOnWall() const {
  Vec3 sum(0, 0, 0);
  for (const Vec3& force : m_forces) sum -= force;
  const double dt = getContext()->getDt();
  return sum / dt;
}

void BeamBlobContact::getConstraintInfo(const ConstraintParams*, VecConstraintBlockInfo& blocks,
                                        VecPersistentID& ids, VecConstCoord&, VecConstDeriv&,
                                        VecConstArea&) {
  if (m_contacts.empty()) return;
  constexpr double kPerMillimetre = 1000;  // samples of the same abscissa are the same
  ConstraintBlockInfo info;
  info.parent = this;
  info.const0 = static_cast<int>(m_firstRow);
  info.nbLines = d_friction.getValue() > 0 ? 3 : 1;
  info.nbGroups = static_cast<int>(m_contacts.size());
  info.hasId = true;
  info.offsetId = static_cast<int>(ids.size());
  for (const Contact& contact : m_contacts)
    ids.push_back(std::llround(m_samples[contact.sample].abscissa * kPerMillimetre));
  blocks.push_back(info);
}

void registerBeamBlobContact(sofa::core::ObjectFactory* factory) {
  factory->registerObjects(
      sofa::core::ObjectRegistrationData("Contact with friction of an instrument's beams with the "
                                         "wall of a lumen case, by samples "
                                         "along each beam whose cursors follow the vessel tree.")
          .add<BeamBlobContact>());
}

}  // namespace lumensofa
