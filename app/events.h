// The timeline of a scene: pushes, pours, tilts, drags, emitters turned on and off, changes of style and moves of the
// eye, as if by a hand.
//
// Nothing here remembers anything: what happens in a stretch of time depends on the scene and on that stretch alone, so
// frames A:B of a film equal the same frames of the whole. Frame n shows the moment n·step. The loop of every command:
//
//   for (n = 0; n < frames; n++) {
//     frame n = sim_world_frame(world, …);
//     events_apply(scene, n * step, step, NULL, &settings, &view, error);  // the style and the eye of frame n
//     draw
//     events_apply(scene, n * step, step, world, NULL, NULL, error);       // what moves the water until frame n + 1
//     sim_world_advance(world, step, …);
//   }
#ifndef LIDO_APP_EVENTS_H
#define LIDO_APP_EVENTS_H

#include "app/app.h"
#include "app/scene.h"
#include "render/render.h"
#include "sim/sim.h"

/// Apply what happens in [time, time + step). World, settings and view may each be NULL.
///
/// World: a push acts for as long as it lasts, its acceleration scaled by the part of the step that it covers; a push
/// that lasts 0 s acts for the whole step in which it falls. A pour fills its box once in every step that it
/// covers, so one that lasts 0 s once. From the first tilt on, gravity is that of the middle of the step (its mean).
/// A drag that the step covers wants its obstacle where events_drag says at the step's end; an emitter is turned in the
/// step in which its event begins.
/// Settings: the style of the last style event that began before time + step. View: where the eye is at `time`. Both
/// are left alone before the first such event.
///
/// Steps of one length that are given as n·step share their borders exactly, so every event falls into one of them.
/// Other times are compared in nanoseconds. An event exactly on a border belongs to the step that begins there.
///
/// false and *error (APP_FAILED, naming the event): the world cannot take more pushes or particles.
bool events_apply(const Scene *scene, double time, double step, SimWorld *world, RenderSettings *settings,
                  RenderView *view, AppError *error);

/// Gravity at a moment, m/s²: the scene's, then linear to that of each tilt over its duration.
void events_gravity(const Scene *scene, double time, float gravity[3]);

/// Where the drags want a draggable obstacle at a moment: at first where the scene puts it, then evenly to the place of
/// each drag over its duration, the short way around.
void events_drag(const Scene *scene, int32_t obstacle, double time, float position[3], float rotation[4]);

#endif
