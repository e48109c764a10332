# The chain from a volume file to a case, timed by stage and beside ITK's multi-scale vesselness.
find_package(ITK 5.2 REQUIRED COMPONENTS ITKCommon ITKImageFeature)
add_executable(lumen_convert_bench
  ${CMAKE_CURRENT_LIST_DIR}/convert_bench.cpp
  ${CMAKE_CURRENT_LIST_DIR}/convert_itk.cpp)
target_link_libraries(lumen_convert_bench PRIVATE
  lumen_reproduce lumen_tracking lumen_fitting lumen_phantom ${ITK_LIBRARIES})
target_compile_definitions(lumen_convert_bench PRIVATE ITK_USE_SYSTEM_EIGEN)
target_include_directories(lumen_convert_bench SYSTEM PRIVATE ${ITK_INCLUDE_DIRS})
if(CMAKE_CXX_COMPILER_ID MATCHES Clang)
  target_compile_options(lumen_convert_bench PRIVATE
    -include ${PROJECT_SOURCE_DIR}/converters/io/volume/itk_for_clang.h)
endif()
