# lumen_blob, over libblob alone.
if(HAS_NUMPY AND NOT LUMEN_SANITIZE)
  python_test(PythonPackage.lumen_blob quick -W error::ResourceWarning -m unittest test_model)
  set_tests_properties(PythonPackage.lumen_blob PROPERTIES
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}/libblob/python/tests
    ENVIRONMENT "PYTHONPATH=${PROJECT_SOURCE_DIR}/libblob/python;LUMEN_BLOB_LIBRARY=$<TARGET_FILE:blob>;LUMEN_BLOB_MODEL=${PROJECT_SOURCE_DIR}/spec/conformance/valid/bifurcation.lumen")
endif()

# The Python package lumen, as its users have it: views, operations, queries, the notebook, the stubs.
if(NOT TARGET lumen_python OR NOT HAS_NUMPY)
  return()
endif()
foreach(part case operations library blob cuda jax jax_rules opencl torch warp stubs notebook)
  python_test(PythonPackage.${part} foreign -W error::ResourceWarning -m unittest test_${part})
  set_tests_properties(PythonPackage.${part} PROPERTIES
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}/packages/python/tests
    ENVIRONMENT "PYTHONPATH=${LUMEN_PYTHON_PATH}")
endforeach()
if(TARGET cuda_stand_in)
  set_tests_properties(PythonPackage.cuda PythonPackage.jax_rules PROPERTIES ENVIRONMENT
    "PYTHONPATH=${LUMEN_PYTHON_PATH};LUMEN_BLOB_CUDA_LIBRARY=$<TARGET_FILE:blob_cuda>;LD_LIBRARY_PATH=$<TARGET_FILE_DIR:cuda_stand_in>")
endif()

