lumen_test(seeds_test
  LABELS memory
  LIBS lumen_seeds
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/seeds/case_seeds_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/seeds/fcsv_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/seeds/markups_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/seeds/place_seeds_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/seeds/seeds_test.cpp)
target_include_directories(seeds_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/unit/volume)
# gcc 12 sees overlaps in sums of texts that are not there (its bug 105651)
target_compile_options(seeds_test PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
