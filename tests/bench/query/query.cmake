# libblob against its rivals, one tool.
include(${CMAKE_CURRENT_LIST_DIR}/../methods/methods.cmake)
set(folder ${CMAKE_CURRENT_LIST_DIR})
add_executable(query_bench ${folder}/query_bench.cpp ${folder}/report.cpp ${folder}/surfaces.cpp)
target_link_libraries(query_bench PRIVATE lumen_bench_methods lumen_surface OpenMeshCore OpenMeshTools lumen_options)

add_executable(seam_sweep ${folder}/seam_sweep.cpp)
target_link_libraries(seam_sweep PRIVATE lumen::blob_static lumen_options)

add_executable(distance_error ${folder}/distance_error.cpp)
target_link_libraries(distance_error PRIVATE lumen::blob_static lumen_options)
