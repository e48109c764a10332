/* SPDX-License-Identifier: Apache-2.0
 *
 * lumen.wasm: lumen/engine.h in numbers and addresses, as a host of WebAssembly passes them. A function that can fail returns
 * a status; lumen_made() is then the address of the product, or lumen_fault() the sentence. The host reads and writes memory
 * by malloc() and free(), and is the listener: its functions are imported from "lumen". */
#include <stdlib.h>

#include "converters/api/include/lumen/engine.h"

#define EXPORT(name) __attribute__((export_name(name)))
#define IMPORT(name) __attribute__((import_module("lumen"), import_name(name)))

IMPORT("stage") extern void hear_stage(const char* name);
IMPORT("progress") extern void hear_progress(double done);
IMPORT("warning") extern void hear_warning(const char* sentence);
IMPORT("is_cancelled") extern int ask_is_cancelled(void);

static lumen_engine_fault fault;
static void* made;

static void on_stage(void* user, const char* name) {
  (void)user;
  hear_stage(name);
}
static void on_progress(void* user, double done) {
  (void)user;
  hear_progress(done);
}
static void on_warning(void* user, const char* sentence) {
  (void)user;
  hear_warning(sentence);
}
static int on_is_cancelled(void* user) {
  (void)user;
  return ask_is_cancelled();
}

static const lumen_engine_listener host = {NULL,       on_stage,        on_progress,
                                           on_warning, on_is_cancelled, 1};

/* Inputs with the array that they may point to. */
typedef struct module_inputs {
  lumen_engine_inputs inputs;
  lumen_engine_volume volume;
} module_inputs;

EXPORT("malloc") void* module_malloc(size_t size) {
  return malloc(size);
}
EXPORT("free") void module_free(void* bytes) {
  free(bytes);
}
EXPORT("lumen_made") void* module_made(void) {
  return made;
}
EXPORT("lumen_fault") const char* module_fault(void) {
  return fault.message;
}
EXPORT("lumen_version") const char* module_version(void) {
  return lumen_engine_version();
}

EXPORT("lumen_create_options") int module_create_options(void) {
  return lumen_engine_create_options((lumen_engine_options**)&made, &fault);
}
EXPORT("lumen_set_option")
int module_set_option(lumen_engine_options* options, const char* name, const char* value) {
  return lumen_engine_set_option(options, name, value, &fault);
}
EXPORT("lumen_free_options") void module_free_options(lumen_engine_options* options) {
  lumen_engine_free_options(options);
}
EXPORT("lumen_list_options") int module_list_options(void) {
  return lumen_engine_list_options((lumen_engine_bytes**)&made, &fault);
}

/* Null if memory is out; to be freed by free(). */
EXPORT("lumen_create_inputs") module_inputs* module_create_inputs(void) {
  return calloc(1, sizeof(module_inputs));
}
/* `part`: 0 main, 1 seeds, 2 corrected, 3 label_map, 4 label_table, 5 centerline. */
EXPORT("lumen_set_file")
void module_set_file(module_inputs* to, int part, const char* name, const void* bytes,
                     size_t size) {
  lumen_engine_file* const files[] = {&to->inputs.main,        &to->inputs.seeds,
                                      &to->inputs.corrected,   &to->inputs.label_map,
                                      &to->inputs.label_table, &to->inputs.centerline};
  const lumen_engine_file file = {name, bytes, size};
  *files[part] = file;
}
/* `affine` has 12 numbers, row by row. */
EXPORT("lumen_set_volume")
void module_set_volume(module_inputs* to, const char* name, const void* data, int type, int nx,
                       int ny, int nz, const double* affine) {
  lumen_engine_volume* const volume = &to->volume;
  volume->name = name;
  volume->data = data;
  volume->type = (lumen_engine_type)type;
  volume->size[0] = nx;
  volume->size[1] = ny;
  volume->size[2] = nz;
  for (int i = 0; i < 12; ++i) volume->affine[i / 4][i % 4] = affine[i];
  to->inputs.volume = volume;
}

EXPORT("lumen_load")
int module_load(const module_inputs* from, const lumen_engine_options* options) {
  return lumen_engine_load(&from->inputs, options, &host, (lumen_engine_source**)&made, &fault);
}
EXPORT("lumen_free_source") void module_free_source(lumen_engine_source* source) {
  lumen_engine_free_source(source);
}
EXPORT("lumen_case_of")
int module_case_of(lumen_engine_source* source, const lumen_engine_options* options) {
  return lumen_engine_case_of(source, options, &host, (lumen_engine_case**)&made, &fault);
}
EXPORT("lumen_open_case")
int module_open_case(const char* name, const void* bytes, size_t size) {
  const lumen_engine_file file = {name, bytes, size};
  return lumen_engine_open_case(&file, (lumen_engine_case**)&made, &fault);
}
EXPORT("lumen_branch_count") size_t module_branch_count(const lumen_engine_case* value) {
  return lumen_engine_branch_count(value);
}
EXPORT("lumen_branch_name")
const char* module_branch_name(const lumen_engine_case* value, size_t branch) {
  return lumen_engine_branch_name(value, branch);
}
EXPORT("lumen_branch_parent")
size_t module_branch_parent(const lumen_engine_case* value, size_t branch) {
  return lumen_engine_branch_parent(value, branch);
}

EXPORT("lumen_encode")
int module_encode(const lumen_engine_case* value, const char* format,
                  const lumen_engine_options* options) {
  return lumen_engine_encode(value, format, options, &host, (lumen_engine_bytes**)&made, &fault);
}
EXPORT("lumen_bytes_data") const void* module_bytes_data(const lumen_engine_bytes* bytes) {
  return lumen_engine_bytes_data(bytes);
}
EXPORT("lumen_bytes_size") size_t module_bytes_size(const lumen_engine_bytes* bytes) {
  return lumen_engine_bytes_size(bytes);
}
EXPORT("lumen_free_bytes") void module_free_bytes(lumen_engine_bytes* bytes) {
  lumen_engine_free_bytes(bytes);
}

EXPORT("lumen_surface_of")
int module_surface_of(const lumen_engine_case* value, const lumen_engine_options* options) {
  return lumen_engine_surface_of(value, options, &host, (lumen_engine_surface**)&made, &fault);
}
/* The fields of lumen_engine_mesh, in their order, each a number of 32 bits. */
EXPORT("lumen_mesh") const lumen_engine_mesh* module_mesh(const lumen_engine_surface* surface) {
  static lumen_engine_mesh mesh;
  mesh = lumen_engine_get_mesh(surface);
  return &mesh;
}
EXPORT("lumen_group_name")
const char* module_group_name(const lumen_engine_surface* surface, size_t group) {
  return lumen_engine_group_name(surface, group);
}
EXPORT("lumen_free_surface") void module_free_surface(lumen_engine_surface* surface) {
  lumen_engine_free_surface(surface);
}
