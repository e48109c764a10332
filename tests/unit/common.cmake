lumen_test(sha256_test
  LABELS memory
  LIBS lumen_base
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/common/files_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/common/sha256_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/common/xml_text_test.cpp)
