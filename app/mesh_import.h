// The triangles of a mesh file as they stand there, not yet joined or checked. It is read in a child process: a file that
// breaks its reader does not break the program.
#ifndef LIDO_APP_MESH_IMPORT_H
#define LIDO_APP_MESH_IMPORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct MeshImport {
  char *cause; ///< (cause_size), the caller's: why it failed, in one line
  size_t cause_size;
  bool out_of_memory;     ///< that is why
  int32_t triangle_count; ///< [1, MESH_FILE_MOST_TRIANGLES]
  float *corner;          ///< (triangle_count, 3, 3), the caller frees it, also after a failure
} MeshImport;

/// Polygons are cut into triangles, all parts of the file put where they belong; points and lines are left out.
bool mesh_import(const char *path, MeshImport *import);

#endif
