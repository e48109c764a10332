# Thousands of tools: libblob against its rivals, and what each gets wrong.
include(${CMAKE_CURRENT_LIST_DIR}/../methods/methods.cmake)
set(folder ${CMAKE_CURRENT_LIST_DIR})
add_library(lumen_contact_count STATIC
  ${folder}/exact_field.cpp
  ${folder}/measure.cpp
  ${folder}/tally.cpp
  ${folder}/wires.cpp)
target_include_directories(lumen_contact_count PUBLIC ${folder})
target_link_libraries(lumen_contact_count PUBLIC lumen_bench_methods PRIVATE TBB::tbb lumen_options)

add_executable(contact_bench ${folder}/closed_mesh.cpp ${folder}/contact_bench.cpp ${folder}/report.cpp)
target_link_libraries(contact_bench PRIVATE lumen_contact_count lumen_surface nlohmann_json::nlohmann_json lumen_options)
