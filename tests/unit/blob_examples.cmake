# What libblob/examples, libblob/python and libblob/wasm build; each part only where it is built.
lumen_test(blob_examples_test
  LIBS lumen_options catheter_rod
  SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/unit/blob_examples/catheter_test.cpp)
target_include_directories(blob_examples_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/unit/blob_examples)
