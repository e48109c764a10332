# SPDX-License-Identifier: Apache-2.0
# The binary interfaces of libblob, libblob-cuda and liblumen-case against packages/abi/*.abi. Types are seen in debugging information, so
# the sources that define the exported functions are compiled once more with it, alone.
if(LUMEN_SANITIZE OR NOT CMAKE_SYSTEM_NAME STREQUAL Linux OR NOT CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  return()
endif()

# abi_library(NAME TARGET VERSION_SCRIPT SOURCE...): these sources of TARGET, as the library that is looked at
function(abi_library name target script)
  add_library(${name} SHARED ${ARGN})
  target_link_libraries(${name} PRIVATE lumen_options)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/libblob/include ${PROJECT_SOURCE_DIR}/libblob/src
    ${PROJECT_SOURCE_DIR}/formats/include)
  target_compile_definitions(${name} PRIVATE BLOB_BUILDING)
  target_compile_options(${name} PRIVATE -g -O0)
  target_link_options(${name} PRIVATE "LINKER:--version-script=${script}")
  set_target_properties(${name} PROPERTIES CXX_VISIBILITY_PRESET hidden UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
endfunction()

set(blob ${PROJECT_SOURCE_DIR}/libblob)
abi_library(blob_abi blob ${blob}/src/exports.map ${blob}/src/api.cpp ${blob}/src/device.cpp ${blob}/src/pose_api.cpp)
get_target_property(case_sources lumen_case_shared SOURCES)
list(TRANSFORM case_sources PREPEND ${PROJECT_SOURCE_DIR}/formats/api/)
abi_library(case_abi lumen_case_shared ${PROJECT_SOURCE_DIR}/formats/api/exports.map ${case_sources})

set(check ${CMAKE_CURRENT_SOURCE_DIR}/check_abi.py)
set(of_blob $<TARGET_FILE:blob> $<TARGET_FILE:blob_abi> ${blob}/include libblob)
set(of_case $<TARGET_FILE:lumen_case_shared> $<TARGET_FILE:case_abi> ${PROJECT_SOURCE_DIR}/formats/include liblumen-case)
python_test(BinaryInterface.OfLibblobIsTheStoredOne foreign ${check} ${of_blob})
set(write_cuda "")
if(TARGET blob_cuda)
  abi_library(cuda_abi blob_cuda ${blob}/cuda/exports.map ${blob}/cuda/blob_cuda.cpp ${blob}/cuda/driver.cpp ${blob}/cuda/uploaded.cpp)
  target_include_directories(cuda_abi PRIVATE ${blob}/cuda)
  set(of_cuda $<TARGET_FILE:blob_cuda> $<TARGET_FILE:cuda_abi> ${blob}/include libblob-cuda)
  python_test(BinaryInterface.OfLibblobCudaIsTheStoredOne foreign ${check} ${of_cuda})
  set(write_cuda COMMAND ${PYTHON} -B ${check} --write ${of_cuda})
endif()
python_test(BinaryInterface.OfLiblumenCaseIsTheStoredOne foreign ${check} ${of_case})
python_test(BinaryInterface.ChangesAreFound foreign ${check} --try-changes ${of_case})
# ninja write_abi: takes the present interfaces as those that are kept
add_custom_target(write_abi
  COMMAND ${PYTHON} -B ${check} --write ${of_blob}
  ${write_cuda}
  COMMAND ${PYTHON} -B ${check} --write ${of_case} VERBATIM)
add_dependencies(write_abi blob blob_abi lumen_case_shared case_abi)
if(TARGET blob_cuda)
  add_dependencies(write_abi blob_cuda cuda_abi)
endif()
