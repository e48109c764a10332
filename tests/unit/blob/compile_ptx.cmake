# SPDX-License-Identifier: Apache-2.0
# Compiles LIBBLOB/device/query.cu to the file PTX by CLANG alone, and looks for its kernel and for calls into libraries.
execute_process(
  COMMAND ${CLANG} -x cuda --cuda-gpu-arch=sm_80 -nocudainc -nocudalib --cuda-device-only -S -O3 -ffp-contract=off
    -Wall -Wextra -Wno-unknown-cuda-version -Werror -I ${LIBBLOB}/include -o ${PTX} ${LIBBLOB}/device/query.cu
  RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "clang does not compile query.cu")
endif()
file(READ ${PTX} text)
if(NOT text MATCHES "\\.visible \\.entry blob_query_points")
  message(FATAL_ERROR "${PTX} has no kernel blob_query_points")
endif()
if(text MATCHES "\\.extern|[\n\t ]call")
  message(FATAL_ERROR "${PTX} calls a function that it does not hold: ${CMAKE_MATCH_0}")
endif()
if(text MATCHES "fma\\.rn\\.f32")
  message(FATAL_ERROR "${PTX} fuses a multiplication and an addition, which rounds otherwise than the library")
endif()
