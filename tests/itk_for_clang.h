// SPDX-License-Identifier: Apache-2.0
// Included before everything else when clang compiles the sources that use ITK. Debian's ITK
// headers carry compiler facts for g++ only and refuse other compilers by name; clang 14 has all
// the features that they need.
#pragma once

#pragma push_macro("__clang__")
#pragma push_macro("__GNUC__")
#undef __clang__
#undef __GNUC__
#define __GNUC__ 12
#include <itk_compiler_detection.h>
#pragma pop_macro("__GNUC__")
#pragma pop_macro("__clang__")
