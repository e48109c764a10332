# libblob against its rivals. Each is used if it is installed: libembree-dev, libcgal-dev (GPL: here
# only, never installed), libfcl-dev, libopenvdb-dev.
set(folder ${CMAKE_CURRENT_LIST_DIR})
add_executable(query_bench
  ${folder}/blob_methods.cpp
  ${folder}/floor.cpp
  ${folder}/grid.cpp
  ${folder}/query_bench.cpp
  ${folder}/report.cpp
  ${folder}/surfaces.cpp)
target_link_libraries(query_bench PRIVATE lumen_surface lumen_case lumen::blob_static OpenMeshCore OpenMeshTools lumen_options)

# A rival's headers are not held to our warnings.
function(lumen_bench_rival name file)
  add_library(query_bench_${name} OBJECT ${folder}/${file})
  target_link_libraries(query_bench_${name} PRIVATE lumen::blob_static ${ARGN})
  target_compile_options(query_bench_${name} PRIVATE -w)
  string(TOUPPER ${name} upper)
  target_compile_definitions(query_bench PRIVATE LUMEN_BENCH_${upper})
  target_link_libraries(query_bench PRIVATE query_bench_${name} ${ARGN})
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

add_executable(seam_sweep ${folder}/seam_sweep.cpp)
target_link_libraries(seam_sweep PRIVATE lumen::blob_static lumen_options)

add_executable(distance_error ${folder}/distance_error.cpp)
target_link_libraries(distance_error PRIVATE lumen::blob_static lumen_options)
