# Ways to answer where the wall is, for the benchmarks: libblob and its rivals. Each rival is used if it is
# installed: libembree-dev, libcgal-dev (GPL: here only, never installed), libfcl-dev, libopenvdb-dev.
include_guard(GLOBAL)
set(folder ${CMAKE_CURRENT_LIST_DIR})
add_library(lumen_bench_methods STATIC
  ${folder}/blob_methods.cpp
  ${folder}/floor.cpp
  ${folder}/grid.cpp
  ${folder}/signed_mesh.cpp
  ${folder}/tubes.cpp
  ${folder}/vessel.cpp)
target_include_directories(lumen_bench_methods PUBLIC ${folder})
target_link_libraries(lumen_bench_methods PUBLIC lumen_case lumen::blob_static
  PRIVATE TBB::tbb lumen_options)

# A rival's headers are not held to our warnings.
function(lumen_bench_rival name file)
  add_library(lumen_bench_${name} OBJECT ${folder}/${file})
  target_link_libraries(lumen_bench_${name} PRIVATE lumen::blob_static ${ARGN})
  target_compile_options(lumen_bench_${name} PRIVATE -w)
  string(TOUPPER ${name} upper)
  target_compile_definitions(lumen_bench_methods PUBLIC LUMEN_BENCH_${upper})
  target_sources(lumen_bench_methods PRIVATE $<TARGET_OBJECTS:lumen_bench_${name}>)
  target_link_libraries(lumen_bench_methods PRIVATE ${ARGN})
endfunction()

find_package(embree 3 QUIET)
if(embree_FOUND)
  lumen_bench_rival(embree embree.cpp embree)
endif()
# CGAL's own package file changes the search for others, and needs a rounding mode that these kernels
# do not; its headers are enough.
find_path(CGAL_INCLUDE CGAL/AABB_tree.h)
find_library(GMP_LIBRARY gmp)
find_library(MPFR_LIBRARY mpfr)
if(CGAL_INCLUDE AND GMP_LIBRARY AND MPFR_LIBRARY)
  lumen_bench_rival(cgal cgal.cpp ${MPFR_LIBRARY} ${GMP_LIBRARY})
endif()
find_package(fcl QUIET)
if(fcl_FOUND)
  lumen_bench_rival(fcl fcl.cpp fcl)
endif()
find_path(OPENVDB_INCLUDE openvdb/openvdb.h)
find_library(OPENVDB_LIBRARY openvdb)
find_library(IMATH_LIBRARY NAMES Imath Imath-3_1)
if(OPENVDB_INCLUDE AND OPENVDB_LIBRARY AND IMATH_LIBRARY)
  lumen_bench_rival(openvdb openvdb.cpp ${OPENVDB_LIBRARY} ${IMATH_LIBRARY} TBB::tbb)
endif()
