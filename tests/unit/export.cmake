lumen_test(grids_test
  LABELS threads
  LIBS lumen_grids lumen_surface
  SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/unit/export/distance_grid_test.cpp)

# Grids in the hands of those who read them, where they are.
find_library(BULLET_COLLISION BulletCollision)
find_library(BULLET_MATH LinearMath)
find_path(BULLET_INCLUDE BulletCollision/CollisionShapes/btSdfCollisionShape.h PATH_SUFFIXES bullet)
if(BULLET_COLLISION AND BULLET_MATH AND BULLET_INCLUDE)
  lumen_test(cdf_test
    LIBS lumen_grids lumen_surface ${BULLET_COLLISION} ${BULLET_MATH}
    SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/unit/export/cdf_test.cpp)
  target_include_directories(cdf_test SYSTEM PRIVATE ${BULLET_INCLUDE})
else()
  message(STATUS "Bullet (libbullet-dev) not found: .cdf files are not read back")
endif()
if(OPENVDB_INCLUDE_DIR AND OPENVDB_LIBRARY)
  lumen_test(vdb_test
    LIBS lumen_grids lumen_surface ${OPENVDB_LIBRARY}
    SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/unit/export/vdb_test.cpp)
  target_include_directories(vdb_test SYSTEM PRIVATE ${OPENVDB_INCLUDE_DIR})
endif()
