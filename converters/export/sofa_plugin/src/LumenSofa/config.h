// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sofa/config.h>

#ifdef LUMENSOFA_BUILDING
#define LUMENSOFA_API SOFA_EXPORT_DYNAMIC_LIBRARY
#else
#define LUMENSOFA_API SOFA_IMPORT_DYNAMIC_LIBRARY
#endif

namespace lumensofa {
constexpr const char* kModuleName = "LumenSofa";
}
