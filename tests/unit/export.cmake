lumen_test(grids_test
  LABELS threads
  LIBS lumen_grids lumen_surface
  SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/unit/export/distance_grid_test.cpp)

# Grids in the hands of those who read them, where they are.
find_library(BULLET_COLLISION BulletCollision)
find_library(BULLET_DYNAMICS BulletDynamics)
find_library(BULLET_MATH LinearMath)
find_path(BULLET_INCLUDE BulletCollision/CollisionShapes/btSdfCollisionShape.h PATH_SUFFIXES bullet)
if(BULLET_DYNAMICS AND BULLET_COLLISION AND BULLET_MATH AND BULLET_INCLUDE)
  lumen_test(cdf_test
    LABELS foreign
    LIBS lumen_grids lumen_surface ${BULLET_DYNAMICS} ${BULLET_COLLISION} ${BULLET_MATH}
    SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/unit/export/cdf_test.cpp)
  target_include_directories(cdf_test SYSTEM PRIVATE ${BULLET_INCLUDE})
else()
  message(STATUS "Bullet (libbullet-dev) not found: .cdf files are not read back")
endif()
if(LUMEN_WRITES_VDB)
  lumen_test(vdb_test
    LABELS foreign
    LIBS lumen_grids lumen_surface ${OPENVDB_LIBRARY} ${IMATH_LIBRARY}
    SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/unit/export/vdb_test.cpp)
  target_include_directories(vdb_test SYSTEM PRIVATE ${OPENVDB_INCLUDE_DIR})
endif()

# The figures of docs/grids.md: not built with the rest.
if(TARGET cdf_test AND TARGET vdb_test)
  add_executable(grid_errors EXCLUDE_FROM_ALL ${CMAKE_CURRENT_SOURCE_DIR}/export/grid_errors.cpp)
  target_link_libraries(grid_errors PRIVATE lumen_grids lumen_surface ${OPENVDB_LIBRARY} ${IMATH_LIBRARY} ${BULLET_COLLISION} ${BULLET_MATH})
  target_include_directories(grid_errors SYSTEM PRIVATE ${OPENVDB_INCLUDE_DIR} ${BULLET_INCLUDE})
endif()

find_package(ITK 5.2 REQUIRED COMPONENTS ITKCommon ITKIOImageBase ITKIOMeta ITKIONIFTI ITKIONRRD)
lumen_test(grid_files_test
  LABELS foreign
  LIBS lumen_export ${ITK_LIBRARIES}
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/export/grid_files_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/volume/itk_reads_test.cpp)
target_include_directories(grid_files_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/unit/volume)
target_compile_definitions(grid_files_test PRIVATE ITK_USE_SYSTEM_EIGEN)
target_include_directories(grid_files_test SYSTEM PRIVATE ${ITK_INCLUDE_DIRS})
if(CMAKE_CXX_COMPILER_ID MATCHES Clang)
  target_compile_options(grid_files_test PRIVATE -include ${PROJECT_SOURCE_DIR}/tests/itk_for_clang.h)
endif()

lumen_test(export_test
  LIBS lumen_export
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/export/export_case_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/export/hostile_labels_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/export/systems_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/export/shared_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/export/wall_files_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/export/named_end_test.cpp)

# One case through every target, located again by the target's own loader; and cases that are hard to export.
python_test(Export.OneCaseIsLocatedAgainInEveryFolder foreign
  ${CMAKE_CURRENT_SOURCE_DIR}/export/landmarks.py $<TARGET_FILE:batch_lumen>)
if(TEST Export.OneCaseIsLocatedAgainInEveryFolder)
  set_tests_properties(Export.OneCaseIsLocatedAgainInEveryFolder PROPERTIES
    ENVIRONMENT "PYTHONPATH=${LUMEN_PYTHON_PATH}")
endif()
set(bad_inputs ${CMAKE_CURRENT_SOURCE_DIR}/export/bad_inputs.py $<TARGET_FILE:batch_lumen>)
python_test(Export.CasesWithoutModelsOrVesselsAreWrittenWholeOrRefused slow
  ${bad_inputs} --cases "without models" "aneurysm only")
python_test(Export.HardCasesAreWrittenWholeOrRefused nightly ${bad_inputs})

# Arrays by NumPy, the stage by three's USD loader.
if(HAS_NUMPY)
  python_test(Isaac.ArraysAndStageAreReadByNumpyAndThree foreign
    ${CMAKE_CURRENT_SOURCE_DIR}/export/check_isaac.py $<TARGET_FILE:lumen>)
endif()
