# SPDX-License-Identifier: Apache-2.0
# blob_cuda: its host side on a stand-in for NVIDIA's driver, which is found by its soname as it is loaded already, and
# the text of its kernels; on a graphics processor, where there is one, its answers.
if(NOT TARGET blob_cuda)
  return()
endif()
set(folder ${CMAKE_CURRENT_SOURCE_DIR}/unit/blob/cuda)
foreach(name stand_in half)
  add_library(cuda_${name} SHARED ${folder}/$<IF:$<STREQUAL:${name},half>,half_driver.c,stand_in_driver.cpp>
    $<$<STREQUAL:${name},stand_in>:${folder}/fibers.cpp>)
  set_target_properties(cuda_${name} PROPERTIES OUTPUT_NAME cuda SOVERSION 1
    LIBRARY_OUTPUT_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/cuda_${name})
  target_link_libraries(cuda_${name} PRIVATE lumen_options)
endforeach()
target_include_directories(cuda_stand_in PRIVATE ${PROJECT_SOURCE_DIR}/libblob/include PUBLIC ${folder})

lumen_test(blob_cuda_test
  LABELS memory
  LIBS lumen_options lumen::blob_cuda cuda_stand_in
  SOURCES ${folder}/answers_test.cpp ${folder}/cuda_test.cpp ${CMAKE_CURRENT_SOURCE_DIR}/unit/blob/tree.cpp)
target_include_directories(blob_cuda_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/unit/blob)

if(LUMEN_SANITIZE)
  return()
endif()
foreach(kind no half)
  add_executable(cuda_with_${kind}_driver ${folder}/without_driver.c)
  target_link_libraries(cuda_with_${kind}_driver PRIVATE lumen::blob_cuda)
  target_compile_options(cuda_with_${kind}_driver PRIVATE -Wall -Wextra -pedantic -Werror)
  set_target_properties(cuda_with_${kind}_driver PROPERTIES C_STANDARD 99 C_STANDARD_REQUIRED ON C_EXTENSIONS OFF)
endforeach()
target_link_libraries(cuda_with_half_driver PRIVATE -Wl,--no-as-needed cuda_half)
add_test(NAME BlobCuda.NoDriverIsAStatus COMMAND cuda_with_no_driver libcuda.so.1)
add_test(NAME BlobCuda.ADriverWithoutAFunctionIsAStatus
  COMMAND cuda_with_half_driver "libcuda.so.1 has no function cuGetErrorString")
set_tests_properties(BlobCuda.NoDriverIsAStatus BlobCuda.ADriverWithoutAFunctionIsAStatus PROPERTIES
  LABELS quick SKIP_RETURN_CODE 77)
# on a graphics processor, where there is one
add_executable(device_cuda ${folder}/../device_cuda.cpp ${folder}/../device_agreement.cpp ${folder}/../tree.cpp)
target_include_directories(device_cuda PRIVATE ${folder}/..)
target_link_libraries(device_cuda PRIVATE lumen_options lumen::blob_cuda cuda_device)
add_test(NAME BlobCuda.AnswersOnADeviceAreThoseOfTheLibrary COMMAND device_cuda)
set_tests_properties(BlobCuda.AnswersOnADeviceAreThoseOfTheLibrary PROPERTIES LABELS foreign SKIP_RETURN_CODE 77)
# the example, on the stand-in
add_executable(cuda_query_points ${PROJECT_SOURCE_DIR}/libblob/examples/cuda/query_points.c ${folder}/runtime/stand_in_runtime.cpp)
target_include_directories(cuda_query_points PRIVATE ${folder}/runtime)
target_link_libraries(cuda_query_points PRIVATE lumen_options lumen::blob_cuda cuda_stand_in)
add_test(NAME BlobCuda.TheExampleRunsOnTheStandIn
  COMMAND cuda_query_points ${LUMEN_CONFORMANCE_SET}/valid/bifurcation.lumen)
set_tests_properties(BlobCuda.TheExampleRunsOnTheStandIn PROPERTIES LABELS quick
  PASS_REGULAR_EXPRESSION "greatest distance -0[.][0-9]+ mm")
python_test(BlobCuda.KernelsRoundAsTheLibraryAndCallNothing quick ${folder}/check_ptx.py
  $<TARGET_FILE_DIR:blob_cuda>/query.ptx)
