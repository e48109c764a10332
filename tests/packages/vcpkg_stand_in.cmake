# SPDX-License-Identifier: Apache-2.0
# cmake -D PORT=FOLDER -D WORK=FOLDER -D VERSION=V -D "FEATURES=a;b" [-D INSTALL=ON] -P vcpkg_stand_in.cmake: runs a portfile
# with functions that do what those of vcpkg do for a port of this kind. Without INSTALL it only configures.
cmake_minimum_required(VERSION 3.25)
set(CURRENT_PACKAGES_DIR ${WORK}/packages)
set(CURRENT_BUILDTREES_DIR ${WORK}/build)

function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY OUTPUT_QUIET)
endfunction()

function(vcpkg_extract_source_archive variable)
  cmake_parse_arguments(ARG "" "ARCHIVE" "" ${ARGN})
  file(REMOVE_RECURSE ${WORK}/source)
  file(ARCHIVE_EXTRACT INPUT ${ARG_ARCHIVE} DESTINATION ${WORK}/source)
  file(GLOB folder ${WORK}/source/*)
  set(${variable} ${folder} PARENT_SCOPE)
endfunction()

function(vcpkg_cmake_configure)
  cmake_parse_arguments(ARG "" "SOURCE_PATH" "OPTIONS" ${ARGN})
  run(${CMAKE_COMMAND} -G Ninja -S ${ARG_SOURCE_PATH} -B ${CURRENT_BUILDTREES_DIR} -D CMAKE_BUILD_TYPE=Release
    -D CMAKE_INSTALL_PREFIX=${CURRENT_PACKAGES_DIR} -D CMAKE_INSTALL_LIBDIR=lib ${ARG_OPTIONS})
endfunction()

function(vcpkg_cmake_install)
  if(INSTALL)
    run(${CMAKE_COMMAND} --build ${CURRENT_BUILDTREES_DIR} --target install)
  endif()
endfunction()

function(vcpkg_cmake_config_fixup)
  cmake_parse_arguments(ARG "" "PACKAGE_NAME;CONFIG_PATH" "" ${ARGN})
  if(INSTALL AND NOT EXISTS ${CURRENT_PACKAGES_DIR}/${ARG_CONFIG_PATH}/${ARG_PACKAGE_NAME}Config.cmake)
    message(FATAL_ERROR "there is no ${ARG_CONFIG_PATH}/${ARG_PACKAGE_NAME}Config.cmake")
  endif()
endfunction()

function(vcpkg_fixup_pkgconfig)
endfunction()

function(vcpkg_install_copyright)
  cmake_parse_arguments(ARG "" "" "FILE_LIST" ${ARGN})
  foreach(file ${ARG_FILE_LIST})
    if(NOT EXISTS ${file})
      message(FATAL_ERROR "${file} is missing")
    endif()
  endforeach()
endfunction()

include(${PORT}/portfile.cmake)
