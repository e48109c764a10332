# The add-on of Blender, installed and used without a window.
python_test(Packages.BlenderImportsAndExportsCases foreign ${CMAKE_CURRENT_SOURCE_DIR}/check_blender.py $<TARGET_FILE:lumen>)
