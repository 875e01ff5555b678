// Triangle meshes from files: one closed surface, ready to be an obstacle.
//
// Files come from outside and are not trusted: their size is bounded, a process of its own reads them, nothing but the
// file itself is read whatever it refers to, and what comes out is checked before it is used.
#ifndef LIDO_APP_MESH_FILE_H
#define LIDO_APP_MESH_FILE_H

#include <stdbool.h>

#include "sim/sim.h"

enum { MESH_FILE_MOST_BYTES = 64 * 1024 * 1024, MESH_FILE_MOST_TRIANGLES = 500000, MESH_FILE_CAUSE_SIZE = 320 };

/// Formats that are read, as endings of file names: "obj, ply, …".
#define MESH_FILE_FORMATS "obj, ply, stl, off, glb, dae, fbx, 3ds"

/// Read the triangles of a mesh file. All parts become one; corners in the same place are joined, triangles without
/// area dropped. `scale` goes from its lengths to metres; with `centre` the middle of its box becomes the origin.
/// Normals point outwards, whichever way the file has them. false and `cause` in one line: it cannot be read, is not
/// closed, or is too large; *memory is false when memory ran out instead.
bool mesh_file_read(const char *path, double scale, bool centre, SimMesh *mesh, char cause[MESH_FILE_CAUSE_SIZE],
                    bool *memory);
void mesh_file_free(SimMesh *mesh);

#endif
