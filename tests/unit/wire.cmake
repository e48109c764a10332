# Guidewires (libblob/wire): closed forms of rods, contact and friction, reproducibility.
if(TARGET blob_wire)
  lumen_test(wire_test FOLDER wire
    SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/unit/blob/tree.cpp ${CMAKE_CURRENT_SOURCE_DIR}/unit/blob/allocations.cpp
    LABELS memory threads
    LIBS lumen_options lumen::blob_wire)
  target_include_directories(wire_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/unit/blob)
endif()
