# The container's description; packages/container/try.sh builds and uses it.
python_test(Packages.ContainerfileKeepsRules quick ${CMAKE_CURRENT_SOURCE_DIR}/check_container.py)
