// Particle files: legacy VTK and PLY, written so that ParaView, Blender, Houdini and meshio read them, and read back, also
// when another program wrote them.
//
// Written: particles in the order of their ids, so that one particle keeps its place from file to file; position, id,
// velocity, density, and colour, radius and class where the frame has them. Time, spacing and container stand in the
// title (VTK) or in a comment (PLY), and come back from there.
// Read: binary and ASCII, either byte order (PLY), any number type, VTK versions 2 to 5.1; attributes and cells that mean
// nothing here are skipped. Names that mean something, in any case:
//   id · velocity, vel, v (PLY: vx vy vz) · density · colour, color, rgb (PLY: red green blue) · radius · class
// Colours of bytes are taken as sRGB, those of floats as linear light. Ids that are not unique whole numbers, and classes
// that are not 0 or 1, mean something else in that program and are not used.
//
// Files are untrusted: whatever they hold, the answer is a particle file or one line that names file, line or byte, and
// cause. The memory used is that of the arrays, for which the file has to be large enough, and a few megabytes.
#ifndef LIDO_APP_PARTICLE_FILE_H
#define LIDO_APP_PARTICLE_FILE_H

#include <stdint.h>
#include <stdio.h>

#include "app/app.h"
#include "sim/sim.h"

/// What a file holds. Arrays that it does not have are NULL.
typedef struct ParticleFile {
  int32_t count;           ///< n; may be 0
  float *position;         ///< m, (n, 3)
  float *velocity;         ///< m/s, (n, 3)
  float *density;          ///< kg/m³, (n)
  float *colour;           ///< linear light, [0, 1], (n, 3)
  float *radius;           ///< m, > 0, (n)
  uint8_t *particle_class; ///< SimClass, (n)
  uint32_t *id;            ///< unique, (n)

  // What files of Lido say about themselves; 0 and false for others.
  double time;           ///< s
  int64_t index;         ///< number of the frame
  float particle_radius; ///< m
  bool has_container;
  SimContainer container;
} ParticleFile;

/// True when the name ends like a particle file: .vtk or .ply.
bool particle_file_named(const char *path);

/// False and *error (APP_BAD_INPUT; APP_FAILED when memory runs out); the file is then empty.
bool particle_file_read(const char *path, ParticleFile *file, AppError *error);
/// The same without ids and densities, which no picture needs: they are checked, but not kept.
bool particle_file_read_to_draw(const char *path, ParticleFile *file, AppError *error);
void particle_file_free(ParticleFile *file);

/// The same as the simulator takes it. Pointers into the file.
SimParticleSet particle_file_set(const ParticleFile *file);

/// Write a frame, as VTK or PLY by the ending of the name. False and *error; then nothing is left.
bool particle_file_write(const char *path, const SimFrame *frame, AppError *error);

// ---- One format each (particle_vtk.c, particle_ply.c) --------------------------------------------------------------------

struct ParticleReader;
/// Read into an empty file.
bool particle_vtk_read(struct ParticleReader *reader, ParticleFile *file);
bool particle_ply_read(struct ParticleReader *reader, ParticleFile *file);
/// Write to a stream, particles in the given order: order[k] is the place in the frame of the k-th one.
void particle_vtk_write(FILE *stream, const SimFrame *frame, const uint32_t *order);
void particle_ply_write(FILE *stream, const SimFrame *frame, const uint32_t *order);

/// "Lido 0.1.0 time=… particle_radius=…" for title or comment, without a newline, at most 255 characters.
void particle_file_title(const SimFrame *frame, char title[256]);

#endif
