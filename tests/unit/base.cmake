lumen_test(base_test
  LABELS memory
  LIBS lumen_base
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/base/files_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/base/sha256_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/base/xml_text_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/base/option_table_test.cpp)
