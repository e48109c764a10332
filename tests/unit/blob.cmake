lumen_test(blob_test FOLDER blob WITHOUT blob_header_cpp.cpp device_agreement.cpp device_cuda.cpp device_opencl.cpp
  LABELS memory threads
  LIBS lumen_options lumen::blob_static lumen_case)
target_include_directories(blob_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/unit/blob)
target_compile_definitions(blob_test PRIVATE LUMEN_CONFORMANCE="${LUMEN_CONFORMANCE_SET}")
add_dependencies(blob_test conformance_set)

# The header as C99 and as C++11, pedantic.
foreach(language C CXX)
  set(name blob_header_${language})
  add_executable(${name} ${CMAKE_CURRENT_SOURCE_DIR}/unit/blob/$<IF:$<STREQUAL:${language},C>,blob_header.c,blob_header_cpp.cpp>)
  target_link_libraries(${name} PRIVATE lumen::blob)
  target_compile_options(${name} PRIVATE -Wall -Wextra -pedantic -Werror)
  set_target_properties(${name} PROPERTIES C_STANDARD 99 C_STANDARD_REQUIRED ON C_EXTENSIONS OFF
    CXX_STANDARD 11 CXX_EXTENSIONS OFF)
  add_test(NAME BlobHeader.IsUsedFrom${language} COMMAND ${name})
  set_tests_properties(BlobHeader.IsUsedFrom${language} PROPERTIES LABELS quick)
endforeach()

# blob_device.h as other processors compile it: OpenCL C, run on whatever device there is (Debian's pocl makes one
# of this processor).
find_package(OpenCL QUIET)
if(OpenCL_FOUND AND NOT LUMEN_SANITIZE)
  set(folder ${CMAKE_CURRENT_SOURCE_DIR}/unit/blob)
  add_executable(device_opencl ${folder}/device_opencl.cpp ${folder}/device_agreement.cpp ${folder}/tree.cpp)
  target_link_libraries(device_opencl PRIVATE lumen_options lumen::blob_static OpenCL::OpenCL)
  target_include_directories(device_opencl PRIVATE ${folder})
  target_compile_definitions(device_opencl PRIVATE CL_TARGET_OPENCL_VERSION=120)
  add_test(NAME BlobDevice.AnswersOnOpenClAreThoseOfTheLibrary COMMAND device_opencl ${PROJECT_SOURCE_DIR}/libblob)
  add_test(NAME BlobDevice.AnswersOnOpenClWithoutVectorsAreThoseOfTheLibrary
    COMMAND device_opencl ${PROJECT_SOURCE_DIR}/libblob --points 100000 --wide 0)
  set_tests_properties(BlobDevice.AnswersOnOpenClAreThoseOfTheLibrary
    BlobDevice.AnswersOnOpenClWithoutVectorsAreThoseOfTheLibrary PROPERTIES LABELS foreign SKIP_RETURN_CODE 77 TIMEOUT 600)
elseif(NOT LUMEN_SANITIZE)
  message(STATUS "OpenCL (ocl-icd-opencl-dev, pocl-opencl-icd) not found: the kernel of libblob/device is not run")
endif()
