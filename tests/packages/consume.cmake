# SPDX-License-Identifier: Apache-2.0
# Installs components blob, case and cuda of BUILD below WORK. Then builds and runs packages/examples and small programs against
# them by find_package and by pkg-config, and configures the sources in ROOT as a folder of another project. With AS_FOLDER it
# builds that instead, and runs make_case.
function(run expected)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT result EQUAL 0 OR NOT out MATCHES "${expected}")
    message(FATAL_ERROR "${ARGN}\nexpected ${expected}\n${out}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
set(consumer ${ROOT}/tests/packages/consumer)
# whether it builds is the question, so it is built fast
set(common -G Ninja -D CMAKE_C_COMPILER=${CC} -D CMAKE_CXX_COMPILER=${CXX} -D LUMEN_ROOT=${ROOT}
  -D CMAKE_BUILD_TYPE=Debug -D CMAKE_CXX_FLAGS_DEBUG=-O0)
set(two_branches "^2 branches, 6 nodes, the last at x = 3 mm\n$")
run("" ${CMAKE_COMMAND} -S ${consumer} -B ${WORK}/folder -D LUMEN_AS_FOLDER=ON -D LUMEN_UNITY=ON ${common})
if(AS_FOLDER)
  # the whole of libblob takes longer to compile, and its targets differ in no way
  run("" ${CMAKE_COMMAND} --build ${WORK}/folder --target make_case)
  run(${two_branches} ${WORK}/folder/make_case ${WORK}/made.lumen)
  return()
endif()

foreach(component blob case cuda) # nothing of cuda where it is not built
  run("" ${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix --component ${component})
endforeach()
foreach(file query.cl query.cu)
  if(NOT EXISTS ${WORK}/prefix/share/libblob/${file})
    message(FATAL_ERROR "share/libblob/${file} is not installed")
  endif()
endforeach()
run("" ${CMAKE_COMMAND} -S ${consumer} -B ${WORK}/installed -D CMAKE_PREFIX_PATH=${WORK}/prefix ${common})
run("" ${CMAKE_COMMAND} --build ${WORK}/installed)
run(${two_branches} ${WORK}/installed/make_case ${WORK}/made.lumen)
run("^trunk: radius 2.00 mm at \\(0.0, 0.0, 0.0\\) LPS\ntwig: radius 1.00 mm .*2 vessels written\n$"
  ${WORK}/installed/widest_places ${WORK}/made.lumen ${WORK}/out.lumen.json)
foreach(program cpp11 uses_blob uses_blob_static)
  run("" ${WORK}/installed/${program})
endforeach()
if(EXISTS ${WORK}/prefix/include/blob_cuda.h)
  execute_process(COMMAND ${WORK}/installed/uses_blob_cuda libcuda.so.1 RESULT_VARIABLE result)
  if(NOT result MATCHES "^(0|77)$") # no driver, or one
    message(FATAL_ERROR "uses_blob_cuda: ${result}")
  endif()
endif()

find_program(PKG_CONFIG pkg-config)
if(NOT PKG_CONFIG)
  message(STATUS "pkg-config is missing: its files are not tried")
  return()
endif()
set(ENV{PKG_CONFIG_PATH} ${WORK}/prefix/${LIBDIR}/pkgconfig)
set(ENV{LD_LIBRARY_PATH} ${WORK}/prefix/${LIBDIR})
foreach(pair "lumen-case:${ROOT}/packages/examples/make_case.c" "blob:${ROOT}/tests/unit/blob/blob_header.c")
  string(REPLACE ":" ";" pair ${pair})
  list(GET pair 0 package)
  list(GET pair 1 source)
  execute_process(COMMAND ${PKG_CONFIG} --cflags --libs ${package} OUTPUT_VARIABLE flags
    OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  separate_arguments(flags)
  run("" ${CC} ${source} -o ${WORK}/by_pkg_config ${flags})
  run("" ${WORK}/by_pkg_config ${WORK}/made.lumen)
endforeach()
