# SPDX-License-Identifier: Apache-2.0
"""lumen for Conan 2: libblob, and the case library with the option with_case. The sources lie beside this file."""
from pathlib import Path

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeToolchain, CMakeDeps, cmake_layout
from conan.tools.files import copy, unzip


class Lumen(ConanFile):
    name = "lumen"
    version = "0.2.0"
    description = "Vessels for simulators: distance to their wall, and the files that hold them"
    license = "Apache-2.0"
    settings = "os", "compiler", "build_type", "arch"
    options = {"with_case": [True, False]}
    default_options = {"with_case": True}
    exports_sources = "lumen-*.tar.gz"

    def layout(self):
        cmake_layout(self, src_folder="source")

    def requirements(self):
        if self.options.with_case:
            self.requires("draco/1.5.6")
            self.requires("zstd/[>=1.5 <2]")
            self.requires("nlohmann_json/[>=3.11 <4]", visible=False)

    def source(self):
        unzip(self, str(Path(self.export_sources_folder) / f"lumen-{self.version}.tar.gz"), strip_root=True)

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        only = "LUMEN_LIBRARIES_ONLY" if self.options.with_case else "LUMEN_LIBBLOB_ONLY"
        toolchain.cache_variables[only] = True
        toolchain.cache_variables["LUMEN_BUILD_TESTS"] = False
        toolchain.cache_variables["LUMEN_BUILD_BENCHMARKS"] = False
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()
        for name in ("LICENSE", "THIRD_PARTY.md"):
            copy(self, name, self.source_folder, str(Path(self.package_folder) / "licenses"))

    def package_info(self):
        # the files of lumen's own CMake package are used as they are installed
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs = ["lib/cmake/lumen"]
        self.cpp_info.components["blob"].libs = ["blob"]
        self.cpp_info.components["blob"].set_property("pkg_config_name", "blob")
        if self.options.with_case:
            case = self.cpp_info.components["case"]
            case.libs = ["lumen-case"]
            case.set_property("pkg_config_name", "lumen-case")
            case.requires = ["draco::draco", "zstd::zstd", "nlohmann_json::nlohmann_json"]
