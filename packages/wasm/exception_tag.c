/* SPDX-License-Identifier: Apache-2.0
 *
 * The tag of C++ exceptions, with their address, which objects of this clang use and none of its libraries defines. */
__asm__(
    ".globl __cpp_exception\n"
    ".tagtype __cpp_exception i32\n"
    "__cpp_exception:\n");
