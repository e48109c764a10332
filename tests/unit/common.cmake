lumen_test(sha256_test
  LABELS memory
  LIBS lumen_sha256
  SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/unit/common/sha256_test.cpp)
