/* SPDX-License-Identifier: Apache-2.0
 * A library with the soname of NVIDIA's driver and one of its functions. */
int cuInit(unsigned flags);

int cuInit(unsigned flags) {
  return (int)flags;
}
