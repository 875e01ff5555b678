// --stats FILE: one JSON object per line and frame, for plots and for tests.
//
// Keys: frame, time (s), particles; and where the water is being simulated: density_error {mean, max} (relative),
// energy {kinetic, potential} (J), max_speed (m/s), substeps, stage_ms {…}; where it is drawn: pass_ms [{name, gpu, cpu}] and
// figures {…}, what the style tells of its picture: of refraction the share of the water's pixels in each order of bodies.
// What is not known (a frame read from a file has no energy) is null. The file appears when the run ends.
#ifndef LIDO_APP_STATS_H
#define LIDO_APP_STATS_H

#include "app/app.h"
#include "render/render.h"
#include "sim/sim.h"

typedef struct Stats Stats;

/// NULL and *error when the file cannot be written.
Stats *stats_open(const char *path, AppError *error);
/// One line. The profile of the world must have been cleared when the frame began. World and render may be NULL.
void stats_frame(Stats *stats, const SimFrame *frame, SimWorld *world, Render *render);
/// Put the file in its place. Frees `stats`, whatever comes of it. NULL is allowed and fine.
bool stats_close(Stats *stats, AppError *error);
void stats_abort(Stats *stats); ///< NULL is allowed

#endif
