lumen_test(sofa_test
  LIBS lumen_sofa
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/sofa/insertion_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/sofa/scene_test.cpp)
