# The modules of 3D Slicer, run as Slicer runs them.
python_test(Packages.SlicerModulesRunAndAreDescribed foreign
  ${CMAKE_CURRENT_SOURCE_DIR}/check_slicer.py $<TARGET_FILE:lumen>)
