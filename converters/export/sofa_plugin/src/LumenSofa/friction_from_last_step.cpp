// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <LumenSofa/friction_from_last_step.h>
#include <sofa/component/constraint/lagrangian/model/UnilateralConstraintResolution.h>

namespace lumensofa {
namespace {

using sofa::type::Vec3;
namespace model = sofa::component::constraint::lagrangian::model;

template <class Base, int Lines>
class FromLastStep : public Base {
public:
  template <class... Arguments>
  FromLastStep(const Vec3 axis[3], Vec3& last, Arguments... arguments)
      : Base(arguments...), m_last(&last) {
    std::copy_n(axis, Lines, m_axis);
  }

  void init(int line, SReal** w, SReal* force) override {
    Base::init(line, w, force);
    begin(line, force);
  }
  void initForce(int line, SReal* force) override { begin(line, force); }
  void store(int line, SReal* force, bool convergence) override {
    Base::store(line, force, convergence);
    m_last->clear();
    for (int i = 0; i < Lines; ++i) *m_last += m_axis[i] * force[line + i];
  }

private:
  void begin(int line, SReal* force) const {
    force[line] = std::max(0.0, m_axis[0] * *m_last);
    for (int i = 1; i < Lines; ++i) force[line + i] = m_axis[i] * *m_last;
  }

  Vec3 m_axis[Lines];
  Vec3* m_last;
};

}  // namespace

sofa::core::behavior::ConstraintResolution* newResolution(double friction, const Vec3 axis[3],
                                                          Vec3& force) {
  if (friction > 0)
    return new FromLastStep<model::UnilateralConstraintResolutionWithFriction, 3>(axis, force,
                                                                                  friction);
  return new FromLastStep<model::UnilateralConstraintResolution, 1>(axis, force);
}

}  // namespace lumensofa
