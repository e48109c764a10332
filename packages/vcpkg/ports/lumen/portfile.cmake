# SPDX-License-Identifier: Apache-2.0
# An overlay port: the archive of the sources lies beside this file, so nothing is fetched.
set(archive ${CMAKE_CURRENT_LIST_DIR}/lumen-${VERSION}.tar.gz)
if(NOT EXISTS ${archive})
  message(FATAL_ERROR "${archive} is missing: packages/vcpkg/build.sh puts it there")
endif()
vcpkg_extract_source_archive(SOURCE_PATH ARCHIVE ${archive})

if("case" IN_LIST FEATURES)
  set(kind -DLUMEN_LIBRARIES_ONLY=ON)
else()
  set(kind -DLUMEN_LIBBLOB_ONLY=ON)
endif()
# libblob is there as both kinds of library whatever the triplet, and the case library shared
set(VCPKG_POLICY_DLLS_IN_STATIC_LIBRARY enabled)
vcpkg_cmake_configure(SOURCE_PATH ${SOURCE_PATH}
  OPTIONS ${kind} -DLUMEN_BUILD_TESTS=OFF -DLUMEN_BUILD_BENCHMARKS=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(PACKAGE_NAME lumen CONFIG_PATH lib/cmake/lumen)
vcpkg_fixup_pkgconfig()
file(REMOVE_RECURSE ${CURRENT_PACKAGES_DIR}/debug/include ${CURRENT_PACKAGES_DIR}/debug/share
  ${CURRENT_PACKAGES_DIR}/share/doc)
vcpkg_install_copyright(FILE_LIST ${SOURCE_PATH}/LICENSE ${SOURCE_PATH}/THIRD_PARTY.md)
