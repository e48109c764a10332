lumen_test(image_fitting_test
  LABELS threads
  LIBS lumen_image_fitting lumen_fitting lumen_tracking lumen_phantom
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/image_fitting/blurred_section_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/image_fitting/contrast_along_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/image_fitting/fit_to_image_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/image_fitting/section_fit_test.cpp)
