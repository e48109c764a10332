# SPDX-License-Identifier: Apache-2.0
# libblob and the case library for programs in C and C++.
lumen_test(case_library_test
  LABELS foreign
  LIBS lumen::case
  SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/case_library_test.cpp)

if(NOT LUMEN_SANITIZE)
  add_test(NAME CppLibraries.AreFoundBuiltAndRunByProjectsOfOthers
    COMMAND ${CMAKE_COMMAND}
      -D BUILD=${PROJECT_BINARY_DIR} -D ROOT=${PROJECT_SOURCE_DIR} -D WORK=${CMAKE_CURRENT_BINARY_DIR}/consumer
      -D LIBDIR=${CMAKE_INSTALL_LIBDIR} -D CC=${CMAKE_C_COMPILER} -D CXX=${CMAKE_CXX_COMPILER}
      # whether it builds is the question, so it is built fast
      "-DFLAGS=-DLUMEN_UNITY=ON;-DCMAKE_BUILD_TYPE=Debug;-DCMAKE_CXX_FLAGS_DEBUG=-O0"
      -P ${CMAKE_CURRENT_SOURCE_DIR}/consume.cmake)
  set_tests_properties(CppLibraries.AreFoundBuiltAndRunByProjectsOfOthers PROPERTIES LABELS foreign)
endif()
