# SPDX-License-Identifier: Apache-2.0
# Installs components blob and case of BUILD below WORK. Then builds and runs packages/examples against them by
# find_package and by pkg-config, and make_case against the sources in ROOT by add_subdirectory with FLAGS.
function(run expected)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT result EQUAL 0 OR NOT out MATCHES "${expected}")
    message(FATAL_ERROR "${ARGN}\nexpected ${expected}\n${out}")
  endif()
endfunction()

# try(FOLDER): both examples, in FOLDER
function(try folder)
  run("^2 branches, 6 nodes, the last at x = 3 mm\n$" ${folder}/make_case ${WORK}/made.lumen)
  run("^trunk: radius 2.00 mm at \\(0.0, 0.0, 0.0\\) LPS\ntwig: radius 1.00 mm .*2 vessels written\n$"
    ${folder}/widest_places ${WORK}/made.lumen ${WORK}/out.lumen.json)
  run("" ${folder}/cpp11)
endfunction()

file(REMOVE_RECURSE ${WORK})
set(consumer ${ROOT}/tests/packages/consumer)
set(common -G Ninja -D CMAKE_C_COMPILER=${CC} -D CMAKE_CXX_COMPILER=${CXX} -D CMAKE_BUILD_TYPE=Release
  -D EXAMPLES=${ROOT}/packages/examples)
foreach(component blob case)
  run("" ${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix --component ${component})
endforeach()
run("" ${CMAKE_COMMAND} -S ${consumer} -B ${WORK}/installed -D CMAKE_PREFIX_PATH=${WORK}/prefix ${common})
run("" ${CMAKE_COMMAND} --build ${WORK}/installed)
try(${WORK}/installed)

run("" ${CMAKE_COMMAND} -S ${consumer} -B ${WORK}/subdirectory -D LUMEN_SOURCES=${ROOT} ${common} ${FLAGS})
# the whole of libblob takes longer to compile, and its targets differ in no way
run("" ${CMAKE_COMMAND} --build ${WORK}/subdirectory --target make_case)
run("^2 branches, 6 nodes" ${WORK}/subdirectory/make_case ${WORK}/made.lumen)

find_program(PKG_CONFIG pkg-config)
if(NOT PKG_CONFIG)
  message(STATUS "pkg-config is missing: its files are not tried")
  return()
endif()
set(ENV{PKG_CONFIG_PATH} ${WORK}/prefix/${LIBDIR}/pkgconfig)
set(ENV{LD_LIBRARY_PATH} ${WORK}/prefix/${LIBDIR})
execute_process(COMMAND ${PKG_CONFIG} --cflags --libs lumen-case blob OUTPUT_VARIABLE flags
  OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(flags)
file(MAKE_DIRECTORY ${WORK}/plain)
run("" ${CC} ${ROOT}/packages/examples/make_case.c -o ${WORK}/plain/make_case ${flags})
run("" ${CXX} -std=c++17 ${ROOT}/packages/examples/widest_places.cpp -o ${WORK}/plain/widest_places ${flags})
run("" ${CXX} -std=c++11 ${WORK}/installed/cpp11.cpp -o ${WORK}/plain/cpp11 ${flags})
try(${WORK}/plain)
