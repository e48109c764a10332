// SPDX-License-Identifier: Apache-2.0
// Functions that SOFA's plugin manager calls.
#include <LumenSofa/config.h>
#include <sofa/core/ObjectFactory.h>

namespace lumensofa {

void registerBlobField(sofa::core::ObjectFactory* factory);
void registerBlobMotion(sofa::core::ObjectFactory* factory);
void registerBlobPose(sofa::core::ObjectFactory* factory);
void registerBeamBlobContact(sofa::core::ObjectFactory* factory);

extern "C" {

LUMENSOFA_API void initExternalModule() {}
LUMENSOFA_API const char* getModuleName() {
  return kModuleName;
}
LUMENSOFA_API const char* getModuleVersion() {
  return LUMEN_VERSION;
}
LUMENSOFA_API const char* getModuleLicense() {
  return "Apache-2.0";
}
LUMENSOFA_API const char* getModuleDescription() {
  return "The vessels of a lumen case as the wall of a scene";
}
LUMENSOFA_API void registerObjects(sofa::core::ObjectFactory* factory) {
  registerBlobField(factory);
  registerBlobMotion(factory);
  registerBlobPose(factory);
  registerBeamBlobContact(factory);
}
}

}  // namespace lumensofa
