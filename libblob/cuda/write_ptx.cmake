# SPDX-License-Identifier: Apache-2.0
# cmake -DCLANG=PATH -DLIBBLOB=FOLDER -DPTX=FILE [-DSOURCE=FILE.cpp] -P write_ptx.cmake: device/query.cu as PTX, and as the
# text of kernels.h. PTX of this capability is what drivers translate for all devices since 2017.
execute_process(
  COMMAND ${CLANG} -x cuda --cuda-gpu-arch=sm_70 -nocudainc -nocudalib --cuda-device-only -S -O3 -ffp-contract=off
    -Wall -Wextra -Wno-unknown-cuda-version -Werror -I ${LIBBLOB}/include -o ${PTX} ${LIBBLOB}/device/query.cu
  RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "clang does not compile query.cu")
endif()
if(SOURCE)
  file(READ ${PTX} text)
  string(REGEX REPLACE "[ \t]*//[^\n]*" "" text "${text}")
  file(WRITE ${SOURCE} "// Made by write_ptx.cmake.\n#include \"kernels.h\"\n\nnamespace lumen::blob::cuda {\n\n"
    "const char kKernels[] = R\"ptx(${text})ptx\";\n\n}  // namespace lumen::blob::cuda\n")
endif()
