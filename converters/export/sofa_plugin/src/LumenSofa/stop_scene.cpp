// SPDX-License-Identifier: Apache-2.0
#include <LumenSofa/stop_scene.h>
#include <sofa/core/behavior/BaseAnimationLoop.h>
#include <sofa/core/objectmodel/BaseContext.h>

namespace lumensofa {

void stopScene(sofa::core::objectmodel::BaseObject& component) {
  component.d_componentState.setValue(sofa::core::objectmodel::ComponentState::Invalid);
  sofa::core::objectmodel::BaseContext* root = component.getContext()->getRootContext();
  if (root == nullptr) return;
  root->setAnimate(false);
  auto* loop = root->get<sofa::core::behavior::BaseAnimationLoop>();
  if (loop != nullptr)
    loop->d_componentState.setValue(sofa::core::objectmodel::ComponentState::Invalid);
}

}  // namespace lumensofa
