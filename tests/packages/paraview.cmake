# ParaView's reader of cases, through VTK's pipeline.
python_test(Packages.ParaViewReadsCases foreign ${CMAKE_CURRENT_SOURCE_DIR}/check_paraview.py $<TARGET_FILE:lumen>)
