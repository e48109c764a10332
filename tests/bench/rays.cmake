# The tree of boxes that wall points come from, against Embree 3.
find_package(embree 3 QUIET)
if(embree_FOUND)
  add_executable(rays_bench ${CMAKE_CURRENT_LIST_DIR}/rays_bench.cpp)
  target_link_libraries(rays_bench PRIVATE lumen_mesh lumen_geometry embree lumen_options)
  target_include_directories(rays_bench SYSTEM PRIVATE ${EMBREE_INCLUDE_DIRS})
endif()
