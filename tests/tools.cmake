# Programs of others that tests are made with, looked up once, and tests by them.

# Debian's Python first: its modules (VTK, NumPy, jsonschema) belong to it.
find_program(PYTHON NAMES python3 PATHS /usr/bin NO_DEFAULT_PATH)
find_program(PYTHON NAMES python3)
find_program(NODE NAMES node nodejs)
find_program(NPM npm)

# python_module(VARIABLE MODULE PACKAGE WITHOUT): whether Python has a module; if not, what is left out is printed.
function(python_module variable module package without)
  set(${variable} OFF PARENT_SCOPE)
  if(NOT PYTHON)
    return()
  endif()
  execute_process(COMMAND ${PYTHON} -c "import ${module}" RESULT_VARIABLE missing OUTPUT_QUIET ERROR_QUIET)
  if(missing)
    message(STATUS "Python's ${module} (${package}) not found: ${without}")
  else()
    set(${variable} ON PARENT_SCOPE)
  endif()
endfunction()
python_module(HAS_NUMPY numpy python3-numpy
  "the Python package is not tested, scenes of SOFA are not run, files of stEVE and of isaac are not read")
python_module(HAS_VTK vtkmodules python3-vtk9 "files are not opened with VTK")
python_module(HAS_JSONSCHEMA jsonschema python3-jsonschema "the JSON answers are not tested")

# python_test(NAME LABEL SCRIPT [ARGUMENT...]): a script that ends with 77 where it cannot be run. None with a sanitizer,
# whose runtime cannot be loaded into Python.
function(python_test name label)
  if(NOT PYTHON OR LUMEN_SANITIZE)
    return()
  endif()
  add_test(NAME ${name} COMMAND ${PYTHON} -B ${ARGN})
  set_tests_properties(${name} PROPERTIES LABELS ${label} SKIP_RETURN_CODE 77)
endfunction()
