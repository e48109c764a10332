lumen_test(gate_test
  LIBS lumen_gate
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/gate/gate_test.cpp)
