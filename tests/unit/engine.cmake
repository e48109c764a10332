# Operations within commands, and apart from them.
lumen_test(engine_test
  LIBS lumen_engine
  SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/unit/engine/operation_test.cpp)
