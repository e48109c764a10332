# SPDX-License-Identifier: Apache-2.0
# cmake -DCLANG=PATH -DKERNELS=FILE.cu -DINCLUDE=FOLDER -DFLAGS="..." -DPTX=FILE [-DSOURCE=FILE.cpp -DNAMESPACE=NAME] -P
# write_ptx.cmake: kernels as PTX, and as the text kKernels of a C++ source. PTX of this capability is what drivers
# translate for all devices since 2017.
separate_arguments(flags UNIX_COMMAND "${FLAGS}")
execute_process(
  COMMAND ${CLANG} -x cuda --cuda-gpu-arch=sm_70 -nocudainc -nocudalib --cuda-device-only -S -O3 ${flags}
    -Wall -Wextra -Wno-unknown-cuda-version -Werror -I ${INCLUDE} -o ${PTX} ${KERNELS}
  RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "clang does not compile ${KERNELS}")
endif()
if(SOURCE)
  file(READ ${PTX} text)
  string(REGEX REPLACE "[ \t]*//[^\n]*" "" text "${text}")
  file(WRITE ${SOURCE} "// Made by write_ptx.cmake.\nnamespace ${NAMESPACE} {\nextern const char kKernels[];\n"
    "const char kKernels[] = R\"ptx(${text})ptx\";\n}\n")
endif()
