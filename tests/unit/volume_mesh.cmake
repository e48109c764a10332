# Cells within closed surfaces. Those that Netgen makes are tested where it is.
lumen_test(volume_mesh_test FOLDER volume_mesh
  LABELS slow
  LIBS lumen_volume_mesh)
if(LUMEN_FILLS)
  add_dependencies(volume_mesh_test lumen_netgen)
  set_tests_properties(volume_mesh_test PROPERTIES
    ENVIRONMENT "PATH=$<TARGET_FILE_DIR:lumen_netgen>:$ENV{PATH}")
endif()
