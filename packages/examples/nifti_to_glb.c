/* SPDX-License-Identifier: Apache-2.0
 * nifti_to_glb IN.nii.gz OUT.glb: the vessels of an angiogram as a surface, by lumen/engine.h. The files are read and
 * written here: the engine sees bytes alone.
 * cc nifti_to_glb.c $(pkg-config --cflags --libs lumen-engine) */
/* First, as it must need nothing before it. */
/* clang-format off */
#include "lumen/engine.h"
/* clang-format on */

#include <stdio.h>
#include <stdlib.h>

static void* read_whole(const char* name, size_t* size) {
  FILE* file = fopen(name, "rb");
  void* bytes = NULL;
  if (!file) return NULL;
  if (fseek(file, 0, SEEK_END) == 0) {
    const long length = ftell(file);
    rewind(file);
    bytes = length > 0 ? malloc((size_t)length) : NULL;
    *size = bytes ? fread(bytes, 1, (size_t)length, file) : 0;
  }
  fclose(file);
  return bytes;
}

static int write_whole(const char* name, const lumen_engine_bytes* bytes) {
  const size_t size = lumen_engine_size(bytes);
  FILE* file = fopen(name, "wb");
  const int is_written = file && fwrite(lumen_engine_data(bytes), 1, size, file) == size;
  return file && fclose(file) == 0 && is_written;
}

static void warn(void* user, const char* sentence) {
  (void)user;
  fprintf(stderr, "warning: %s\n", sentence);
}

int main(int count, char** arguments) {
  lumen_engine_inputs inputs = {{0}, {0}, {0}};
  lumen_engine_listener listener = {0};
  lumen_engine_source* source = NULL;
  lumen_engine_case* vessels = NULL;
  lumen_engine_bytes* mesh = NULL;
  lumen_engine_fault fault = {{0}};
  void* bytes = count == 3 ? read_whole(arguments[1], &inputs.main.size) : NULL;
  int is_done = 0;
  if (!bytes) return fputs("usage: nifti_to_glb IN.nii.gz OUT.glb\n", stderr), 2;
  inputs.main.name = arguments[1];
  inputs.main.bytes = bytes;
  listener.warning = warn;
  if (lumen_engine_load(&inputs, NULL, &listener, &source, &fault) ||
      lumen_engine_case_of(source, NULL, &listener, &vessels, &fault) ||
      lumen_engine_encode(vessels, "glb", NULL, &listener, &mesh, &fault))
    fprintf(stderr, "%s\n", fault.message);
  else
    is_done = write_whole(arguments[2], mesh);
  lumen_engine_free_bytes(mesh);
  lumen_engine_free_case(vessels);
  lumen_engine_free_source(source);
  free(bytes);
  return is_done ? 0 : 1;
}
