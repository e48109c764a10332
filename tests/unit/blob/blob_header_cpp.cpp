// SPDX-License-Identifier: Apache-2.0
// blob_header.c again, as C++11.
#include "blob_header.c"
