# SPDX-License-Identifier: Apache-2.0
# The recipes of vcpkg and Conan, in which stand-ins of these programs configure the archive that lies beside them.
python_test(Recipes.ConfigureTheSourcesThatLieBesideThem foreign ${CMAKE_CURRENT_SOURCE_DIR}/check_recipes.py ${CMAKE_COMMAND})
